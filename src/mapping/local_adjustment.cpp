#include "mapping/local_adjustment.h"

#include <algorithm>
#include <cassert>
#include <set>

#include "map/worlds.h"
#include "mapping/inertial_alignment_estimate.h"
#include "mapping/inertial_terms.h"
#include "mapping/line_bundle.h"
#include "mapping/motion_along_lines.h"
#include "mapping/wheel_terms.h"

namespace edgeslam {
namespace {

// The new keyframe and those covisible with it, best first.
std::vector<KeyframeId> covisibleKeyframes(const Map& map, const LocalAdjustmentOptions& options) {
  const KeyframeId latest = map.keyframes.back().id;
  const std::vector<int> shared = sharedPoints(map, latest);
  const int most = *std::max_element(shared.begin(), shared.end());
  const double enough = std::min<double>(options.covisible_points, options.covisible_share * most);
  std::vector<KeyframeId> covisible;
  for (const Keyframe& keyframe : map.keyframes) {
    if (shared[static_cast<std::size_t>(keyframe.id)] > 0 && shared[static_cast<std::size_t>(keyframe.id)] >= enough) {
      covisible.push_back(keyframe.id);
    }
  }
  std::stable_sort(covisible.begin(), covisible.end(), [&](KeyframeId a, KeyframeId b) {
    return shared[static_cast<std::size_t>(a)] > shared[static_cast<std::size_t>(b)];
  });
  covisible.insert(covisible.begin(), latest);
  if (static_cast<int>(covisible.size()) > options.free_keyframes)
    covisible.resize(static_cast<std::size_t>(options.free_keyframes));
  return covisible;
}

bool sees(const std::vector<int>& camera_of, KeyframeId keyframe) {
  return camera_of[static_cast<std::size_t>(keyframe)] >= 0;
}

// Points that the free keyframes see.
std::vector<PointId> pointsSeenBy(const Map& map, const std::vector<int>& camera_of) {
  std::vector<PointId> points;
  for (const auto& [id, point] : map.points) {
    if (sees(camera_of, point.host) ||
        std::any_of(point.seen_in.begin(), point.seen_in.end(), [&](KeyframeId k) { return sees(camera_of, k); })) {
      points.push_back(id);
    }
  }
  return points;
}

void removeOutliers(const std::vector<std::pair<PointId, KeyframeId>>& outliers, const std::vector<PointId>& points,
                    double largest_depth_sigma, Map& map) {
  for (const auto& [id, keyframe] : outliers) {
    auto& seen_in = map.points.at(id).seen_in;
    seen_in.erase(std::remove(seen_in.begin(), seen_in.end(), keyframe), seen_in.end());
  }
  for (const PointId id : points) {
    const MapPoint& point = map.points.at(id);
    const bool depth_lost =
        point.inverse_depth <= 0 || point.inverse_depth_sigma > largest_depth_sigma * point.inverse_depth;
    if (point.seen_in.empty() || depth_lost) map.points.erase(id);
  }
}

// The newest of those farthest; after a loop the newest camera of all may be where the first is.
int farthestFromFirst(const std::vector<BundleCamera>& cameras) {
  int farthest = static_cast<int>(cameras.size()) - 1;
  double largest = 0;
  for (std::size_t i = cameras.size(); i-- > 1;) {
    const double distance = (cameras[i].world_T_camera.translation - cameras.front().world_T_camera.translation).norm();
    if (distance <= largest) continue;
    largest = distance;
    farthest = static_cast<int>(i);
  }
  return farthest;
}

// Those at least half as far from the first as the farthest, itself among them.
std::vector<int> farFromFirst(const std::vector<BundleCamera>& cameras, int farthest) {
  const auto distance = [&](int camera) {
    return (cameras[static_cast<std::size_t>(camera)].world_T_camera.translation -
            cameras.front().world_T_camera.translation)
        .norm();
  };
  std::vector<int> far;
  for (int camera = 1; camera < static_cast<int>(cameras.size()); ++camera) {
    if (distance(camera) >= 0.5 * distance(farthest)) far.push_back(camera);
  }
  return far;
}

// Where most of the points that the latest keyframe sees are on lines: all keyframes that see one of the lines which
// the given ones see. Else none.
std::vector<KeyframeId> allThatSeeTheLines(const LineOptions& options, const Map& map,
                                           const std::vector<KeyframeId>& keyframes) {
  const std::map<PointId, LineId> on_lines = pointsOnLines(map, keyframes);
  if (on_lines.empty()) return {};
  int points = 0, points_on_lines = 0;
  for (const PointObservation& seen : map.keyframes.back().observations) {
    if (map.points.count(seen.point) == 0) continue;
    ++points;
    points_on_lines += on_lines.count(seen.point) > 0 ? 1 : 0;
  }
  if (points_on_lines == 0 || points_on_lines < options.bare_share * points) return {};
  std::set<LineId> lines;
  for (const auto& [point, line] : on_lines) lines.insert(line);
  std::set<KeyframeId> all(keyframes.begin(), keyframes.end());
  for (const LineId line : lines) {
    const std::vector<KeyframeId>& seen_in = map.lines.at(line).seen_in;
    all.insert(seen_in.begin(), seen_in.end());
  }
  return {all.begin(), all.end()};
}

// How the keyframe's world lies to the earth; null where that is not known, or there is no unit that counts.
const InertialAlignment* alignmentOf(const LocalAdjustmentOptions& options, const Map& map, KeyframeId keyframe) {
  const auto known = map.inertia.find(map.keyframes[keyframe].world);
  const bool has_unit = options.inertia && !map.unit_is_left_out;
  return has_unit && known != map.inertia.end() ? &known->second : nullptr;
}

WheelScale wheelScaleOf(const Map& map, int world) {
  const auto known = map.wheels.find(world);
  return known != map.wheels.end() ? known->second : WheelScale();
}

void readInertia(const BundleInertia& adjusted, const InertiaMatrix& covariance, InertialAlignment& alignment) {
  alignment.metres_a_unit = adjusted.metres_a_unit;
  alignment.gravity = adjusted.gravity;
  alignment.bias = {adjusted.bias_change.head<3>(), adjusted.bias_change.tail<3>()};
  alignment.scale_sigma = alignment.adjusted_scale_sigma = honest_times * std::sqrt(covariance(0, 0));
  alignment.rate_bias_sigma = honest_times * std::sqrt(covariance.diagonal().segment<3>(3).maxCoeff());
  alignment.force_bias_sigma = honest_times * std::sqrt(covariance.diagonal().tail<3>().maxCoeff());
}

}  // namespace

bool adjustLocally(const Camera& camera, const LocalAdjustmentOptions& options, Map& map) {
  assert(!map.keyframes.empty());
  std::vector<KeyframeId> free = covisibleKeyframes(map, options);
  if (const std::vector<KeyframeId> all = allThatSeeTheLines(options.lines, map, free); !all.empty()) free = all;
  // Keyframes that share most points with the free ones hold the gauge.
  std::vector<int> shared(numberOfKeyframes(map), 0);
  for (const KeyframeId keyframe : free) {
    const std::vector<int> counts = sharedPoints(map, keyframe);
    for (std::size_t k = 0; k < counts.size(); ++k) shared[k] += counts[k];
  }
  for (const KeyframeId keyframe : free) shared[static_cast<std::size_t>(keyframe)] = 0;
  std::vector<KeyframeId> fixed;
  for (const Keyframe& keyframe : map.keyframes) {
    if (shared[static_cast<std::size_t>(keyframe.id)] > 0) fixed.push_back(keyframe.id);
  }
  std::stable_sort(fixed.begin(), fixed.end(), [&](KeyframeId a, KeyframeId b) {
    return shared[static_cast<std::size_t>(a)] > shared[static_cast<std::size_t>(b)];
  });
  if (static_cast<int>(fixed.size()) > options.fixed_keyframes)
    fixed.resize(static_cast<std::size_t>(options.fixed_keyframes));
  return adjustKeyframes(camera, options, free, fixed, map);
}

bool adjustKeyframes(const Camera& camera, const LocalAdjustmentOptions& options, const std::vector<KeyframeId>& free,
                     const std::vector<KeyframeId>& fixed, Map& map, const std::atomic<bool>* interrupted,
                     double* cost) {
  BundleProblem problem;
  std::vector<int> camera_of(numberOfKeyframes(map), -1);  // index in the problem, by keyframe
  std::vector<KeyframeId> keyframe_of;
  const auto addCamera = [&](KeyframeId keyframe, bool is_fixed) {
    camera_of[static_cast<std::size_t>(keyframe)] = static_cast<int>(problem.cameras.size());
    problem.cameras.push_back({map.keyframes[keyframe].world_T_camera, is_fixed, map.keyframes[keyframe].twist});
    keyframe_of.push_back(keyframe);
  };
  std::vector<KeyframeId> ordered_free = free;
  std::sort(ordered_free.begin(), ordered_free.end());
  // A world's first keyframe is its origin and never moves. With nothing else to hold it, the oldest keyframe holds the
  // pose, and the one farthest from it the scale, for as long as the others that are far agree.
  const bool hold_oldest = fixed.empty();
  const KeyframeId origin = firstKeyframeOf(map, map.keyframes[ordered_free.front()].world);
  for (const KeyframeId keyframe : ordered_free) {
    addCamera(keyframe, keyframe == origin || (hold_oldest && keyframe == ordered_free.front()));
  }
  const std::vector<PointId> points = pointsSeenBy(map, camera_of);
  for (const KeyframeId keyframe : fixed) addCamera(keyframe, true);
  if (hold_oldest) {
    problem.scale_camera = farthestFromFirst(problem.cameras);
    problem.scale_cameras = farFromFirst(problem.cameras, problem.scale_camera);
  }

  const auto cameraOf = [&](KeyframeId keyframe) {
    if (camera_of[static_cast<std::size_t>(keyframe)] < 0) addCamera(keyframe, true);
    return camera_of[static_cast<std::size_t>(keyframe)];
  };
  const LinesInBundle lines = addLines(ordered_free, map, cameraOf, problem);

  std::vector<PointId> used_points;
  std::vector<std::pair<PointId, KeyframeId>> observed;
  for (const PointId id : points) {
    if (lines.line_of_point.count(id) > 0) continue;
    const MapPoint& point = map.points.at(id);
    const int index = static_cast<int>(problem.points.size());
    BundlePoint bundle_point;
    bundle_point.host = cameraOf(point.host);
    bundle_point.host_bearing = point.host_bearing;
    bundle_point.inverse_depth = point.inverse_depth;
    problem.points.push_back(bundle_point);
    used_points.push_back(id);
    for (const KeyframeId keyframe : point.seen_in) {
      if (camera_of[static_cast<std::size_t>(keyframe)] < 0) continue;
      const PointObservation* observation = findObservation(map.keyframes[keyframe], id);
      problem.observations.push_back({camera_of[static_cast<std::size_t>(keyframe)], index, observation->measurement});
      observed.emplace_back(id, keyframe);
    }
  }
  const auto indexOf = [&](KeyframeId keyframe) { return camera_of[static_cast<std::size_t>(keyframe)]; };
  addMotionAlongLines(camera, map, lines.lines, indexOf, problem);
  const InertialAlignment* const alignment = alignmentOf(options, map, ordered_free.front());
  if (alignment) {
    addInertialTerms(turnedAsFound(*options.inertia, map.unit_rotation), *alignment, options.inertia_is_free, map,
                     ordered_free, cameraOf, problem);
  }
  if (options.wheels) {
    const WheelScale scale = wheelScaleOf(map, map.keyframes[ordered_free.front()].world);
    std::optional<GyroscopeBeside> gyroscope;
    if (alignment) {
      const InertialUnit unit = turnedAsFound(*options.inertia, map.unit_rotation);
      gyroscope = {unit.imu_T_camera.rotation.conjugate(), alignment->bias};
    }
    addWheelTerms(*options.wheels, scale, gyroscope, map, ordered_free, cameraOf, problem);
    if (!problem.ways.empty()) problem.scale_camera = -1;  // the wheels hold the scale
    if (scale.is_known) {
      problem.inertia.told_metres_a_unit = scale.metres_a_unit;
      problem.inertia.told_scale_sigma = held_scale_sigma;
    }
  }
  const BundleResult result = adjustBundle(camera, problem, options.bundle, interrupted);
  if (cost) *cost = result.final_cost;
  if (!result.usable) return false;
  if (problem.inertia.is_free) {
    const int world = map.keyframes[ordered_free.front()].world;
    InertialAlignment& adjusted = map.inertia[world];
    readInertia(problem.inertia, result.inertia_covariance, adjusted);
    if (const WheelScale scale = wheelScaleOf(map, world); scale.is_known) adjusted.scale_sigma = scale.sigma;
  }

  for (std::size_t k = 0; k < problem.cameras.size(); ++k) {
    Keyframe& keyframe = map.keyframes[keyframe_of[k]];
    if (!problem.cameras[k].fixed) keyframe.world_T_camera = problem.cameras[k].world_T_camera;
    keyframe.twist = problem.cameras[k].twist;
  }
  for (std::size_t i = 0; i < used_points.size(); ++i) {
    MapPoint& point = map.points.at(used_points[i]);
    point.inverse_depth = problem.points[i].inverse_depth;
    if (result.depth_sigmas[i] > 0) point.inverse_depth_sigma = result.depth_sigmas[i];
  }
  const bool were_misled = readLines(camera, options.lines, problem, result, lines, map);
  std::vector<std::pair<PointId, KeyframeId>> outliers;
  for (std::size_t k = 0; k < observed.size(); ++k) {
    if (!(result.errors[k] < options.outlier)) outliers.push_back(observed[k]);
  }
  removeOutliers(outliers, used_points, options.largest_depth_sigma, map);
  // What lines that are none have pulled away goes back without them.
  if (were_misled) adjustKeyframes(camera, options, free, fixed, map, interrupted);
  return true;
}

}  // namespace edgeslam
