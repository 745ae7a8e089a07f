#include "mapping/map_uncertainty.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "adjustment/pose_adjustment.h"
#include "geometry/median.h"
#include "geometry/squared.h"
#include "map/worlds.h"

namespace edgeslam {
namespace {

// Of a keyframe that nothing ties to another: all of the map's extent and any direction.
constexpr double unknown_variance = 1;

struct SharedPoints {
  PoseObservations observations;
  double scale_information = 0;   // sum over the points of (depth over its standard deviation)^2
  std::vector<double> distances;  // from the keyframe
};

struct SeenPoint {
  const PointObservation* seen;
  const MapPoint* point;
};

// Those map points that both see and that `keyframe` does not host, as it sees them.
std::vector<SeenPoint> seenByBoth(const Map& map, const Keyframe& keyframe, KeyframeId other) {
  std::vector<SeenPoint> both;
  for (const PointObservation& seen : keyframe.observations) {
    const auto found = map.points.find(seen.point);
    if (found == map.points.end() || found->second.host == keyframe.id) continue;
    const MapPoint& point = found->second;
    const auto in = [&](KeyframeId id) { return std::binary_search(point.seen_in.begin(), point.seen_in.end(), id); };
    if (in(keyframe.id) && (point.host == other || in(other))) both.push_back({&seen, &point});
  }
  return both;
}

SharedPoints pointsSharedWith(const Camera& camera, const MapUncertaintyOptions& options, const Map& map,
                              const Keyframe& keyframe, KeyframeId other) {
  const std::vector<SeenPoint> both = seenByBoth(map, keyframe, other);
  std::vector<int> on_edge(keyframe.straight_edges.size(), 0);
  const auto onItsEdge = [&](const PointObservation& seen) -> int& {
    return on_edge[static_cast<std::size_t>(seen.straight_edge)];
  };
  for (const SeenPoint& shown : both) {
    if (shown.seen->straight_edge >= 0) ++onItsEdge(*shown.seen);
  }
  SharedPoints shared;
  const Pose camera_T_world = keyframe.world_T_camera.inverse();
  for (const SeenPoint& shown : both) {
    const PointObservation& seen = *shown.seen;
    const MapPoint& point = *shown.point;
    Measurement measurement = seen.measurement;
    double share = 1;  // of what it would tell if its error were its own
    if (seen.straight_edge >= 0) {
      share = std::min(1.0, options.independent_on_edge / onItsEdge(seen));
      measurement.sigma_normal /= std::sqrt(share);
      measurement.sigma_tangent = unknown_along;
    }
    const Eigen::Vector3d position = worldPosition(map, point);
    shared.observations.push_back(observeWithDepth(camera, camera_T_world * map.keyframes[point.host].world_T_camera,
                                                   {point.host_bearing, point.inverse_depth, point.inverse_depth_sigma},
                                                   position, measurement));
    shared.distances.push_back((position - keyframe.world_T_camera.translation).norm());
    if (point.inverse_depth_sigma > 0) {
      const double relative = point.inverse_depth / point.inverse_depth_sigma;
      shared.scale_information += share * relative * relative;
    }
  }
  return shared;
}

// How much farther a way leads astray where the view is narrow. A turn and a motion to the side differ in how the
// image's middle moves against its sides, which grows with the square of the half view's tangent.
double narrowness(const Camera& camera, double narrow_view) {
  const double half_view = 0.5 * std::max(camera.width / camera.fx, camera.height / camera.fy);
  return std::max(1.0, squared(narrow_view / half_view));
}

// What the points that both see leave open of `keyframe` relative to `other`, and how far the way between them leads
// astray.
std::optional<Matrix7d> seenUncertainty(const Camera& camera, const MapUncertaintyOptions& options, const Map& map,
                                        const Keyframe& keyframe, KeyframeId other_id) {
  const Keyframe& other = map.keyframes[other_id];
  const Pose keyframe_T_other = keyframe.world_T_camera.inverse() * other.world_T_camera;
  const SharedPoints seen_here = pointsSharedWith(camera, options, map, keyframe, other_id);
  const SharedPoints seen_there = pointsSharedWith(camera, options, map, other, keyframe.id);
  const Matrix6d carry = updateCarrying(keyframe_T_other).topLeftCorner<6, 6>();
  const bool here = seen_here.observations.size() >= seen_there.observations.size();
  const SharedPoints& more = here ? seen_here : seen_there;
  if (static_cast<int>(more.observations.size()) < options.fewest_points || !(more.scale_information > 0))
    return std::nullopt;
  Matrix6d information = poseInformation(camera, (here ? keyframe : other).world_T_camera, more.observations);
  if (!here) information = carry.transpose() * information * carry;
  const Eigen::LDLT<Matrix6d> factor(information);
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 1e-3)) return std::nullopt;
  const double depth = upperMedian(std::vector<double>(more.distances));
  const double way = keyframe_T_other.translation.norm() / depth +
                     rotationAngle(keyframe.world_T_camera.rotation, other.world_T_camera.rotation);
  Matrix7d link = Matrix7d::Zero();
  link.topLeftCorner<6, 6>() = squared(options.pose_factor) * factor.solve(Matrix6d::Identity()).eval();
  link(6, 6) = squared(options.scale_factor) / more.scale_information;
  const double astray = narrowness(camera, options.narrow_view);
  link.diagonal().head<3>().array() += squared(astray * options.position_walk * depth) * way;
  link.diagonal().segment<3>(3).array() += squared(astray * options.rotation_walk) * way;
  link(6, 6) += squared(options.scale_walk) * way;
  return link;
}

// What the wheels leave open.
std::optional<Matrix7d> drivenUncertainty(const MapUncertaintyOptions& options, const Map& map,
                                          const Keyframe& keyframe, const Keyframe& other) {
  const auto scale = map.wheels.find(keyframe.world);
  if (!options.wheels || scale == map.wheels.end() || !scale->second.is_known) return std::nullopt;
  const std::optional<WheelMotion> driven = wheelMotion(*options.wheels, other.wheels, keyframe.wheels);
  if (!driven) return std::nullopt;
  Matrix7d link = Matrix7d::Zero();
  link.topLeftCorner<6, 6>() = driven->covariance;
  link.topRows<3>() /= scale->second.metres_a_unit;
  link.leftCols<3>() /= scale->second.metres_a_unit;
  link(6, 6) = squared(scale->second.sigma);
  return link;
}

// By the points, or else by the wheels.
std::optional<Matrix7d> linkUncertainty(const Camera& camera, const MapUncertaintyOptions& options, const Map& map,
                                        const Keyframe& keyframe, KeyframeId other_id) {
  const std::optional<Matrix7d> seen = seenUncertainty(camera, options, map, keyframe, other_id);
  return seen ? seen : drivenUncertainty(options, map, keyframe, map.keyframes[other_id]);
}

// Lengths count in map units: the scene of the map's start is one away.
double sizeOf(const Matrix7d& uncertainty) { return uncertainty.trace(); }

// Those that share most points, best first; and with wheels the one before.
std::vector<KeyframeId> neighboursOf(const MapUncertaintyOptions& options, const Map& map, KeyframeId keyframe) {
  const std::vector<int> shared = sharedPoints(map, keyframe);
  std::vector<KeyframeId> neighbours;
  for (const Keyframe& other : map.keyframes) {
    if (other.id != keyframe && shared[static_cast<std::size_t>(other.id)] >= options.fewest_points)
      neighbours.push_back(other.id);
  }
  std::stable_sort(neighbours.begin(), neighbours.end(), [&](KeyframeId a, KeyframeId b) {
    return shared[static_cast<std::size_t>(a)] > shared[static_cast<std::size_t>(b)];
  });
  if (static_cast<int>(neighbours.size()) > options.neighbours)
    neighbours.resize(static_cast<std::size_t>(options.neighbours));
  const KeyframeId before = options.wheels ? keyframeBefore(map, keyframe) : -1;
  if (before >= 0 && std::find(neighbours.begin(), neighbours.end(), before) == neighbours.end())
    neighbours.push_back(before);
  return neighbours;
}

Matrix7d through(const Map& map, const Keyframe& keyframe, KeyframeId other, const Matrix7d& link) {
  const Keyframe& known = map.keyframes[other];
  return carriedUncertainty(known.uncertainty, known.world_T_camera.inverse() * keyframe.world_T_camera) + link;
}

Matrix7d unknownFrom(const Map& map, const Keyframe& keyframe, KeyframeId other) {
  return through(map, keyframe, other, unknown_variance * Matrix7d::Identity());
}

// By keyframe number: those that it shares most points with, and those that it is one of the best for.
std::vector<std::vector<KeyframeId>> links(const MapUncertaintyOptions& options, const Map& map) {
  std::vector<std::vector<KeyframeId>> linked(numberOfKeyframes(map));
  for (const Keyframe& keyframe : map.keyframes) {
    for (const KeyframeId other : neighboursOf(options, map, keyframe.id)) {
      linked[static_cast<std::size_t>(keyframe.id)].push_back(other);
      linked[static_cast<std::size_t>(other)].push_back(keyframe.id);
    }
  }
  return linked;
}

// Dijkstra's shortest paths from the world's first keyframe. `linked`: see links().
void renewUncertaintyOf(const Camera& camera, const MapUncertaintyOptions& options,
                        const std::vector<std::vector<KeyframeId>>& linked, int world, Map& map) {
  const double never = std::numeric_limits<double>::infinity();
  std::vector<double> best(numberOfKeyframes(map), never);
  std::vector<char> settled(numberOfKeyframes(map), 0);
  const auto at = [](KeyframeId id) { return static_cast<std::size_t>(id); };
  KeyframeId last_settled = -1;
  for (std::size_t count = keyframesOf(map, world).size(); count > 0; --count) {
    Keyframe* next = nullptr;
    for (Keyframe& keyframe : map.keyframes) {
      if (settled[at(keyframe.id)] || keyframe.world != world) continue;
      if (!next || best[at(keyframe.id)] < best[at(next->id)]) next = &keyframe;
    }
    if (best[at(next->id)] == never) {  // the first one, or one that nothing ties to the others
      next->uncertainty = last_settled < 0 ? Matrix7d::Zero() : unknownFrom(map, *next, last_settled);
    }
    settled[at(next->id)] = 1;
    last_settled = next->id;
    for (const KeyframeId other : linked[at(next->id)]) {
      if (settled[at(other)]) continue;
      Keyframe& neighbour = map.keyframes[other];
      const std::optional<Matrix7d> link = linkUncertainty(camera, options, map, neighbour, next->id);
      if (!link) continue;
      const Matrix7d found = through(map, neighbour, next->id, *link);
      if (sizeOf(found) >= best[at(other)]) continue;
      best[at(other)] = sizeOf(found);
      neighbour.uncertainty = found;
    }
  }
}

}  // namespace

void addUncertainty(const Camera& camera, const MapUncertaintyOptions& options, Map& map) {
  if (map.keyframes.empty()) return;
  Keyframe& latest = map.keyframes.back();
  const KeyframeId before = keyframeBefore(map, latest.id);
  if (before < 0) return;
  latest.uncertainty = unknownFrom(map, latest, before);
  for (const KeyframeId other : neighboursOf(options, map, latest.id)) {
    const std::optional<Matrix7d> link = linkUncertainty(camera, options, map, latest, other);
    if (!link) continue;
    const Matrix7d found = through(map, latest, other, *link);
    if (sizeOf(found) < sizeOf(latest.uncertainty)) latest.uncertainty = found;
  }
}

void renewUncertainty(const Camera& camera, const MapUncertaintyOptions& options, Map& map) {
  const std::vector<std::vector<KeyframeId>> linked = links(options, map);
  for (const int world : worldsOf(map)) renewUncertaintyOf(camera, options, linked, world, map);
}

}  // namespace edgeslam
