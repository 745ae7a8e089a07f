#include "mapping/track_loss_recovery.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "adjustment/reprojection.h"
#include "geometry/epipolar.h"
#include "geometry/median.h"
#include "geometry/resectioning.h"
#include "geometry/triangulation.h"

namespace edgeslam {
namespace {

constexpr double degree = M_PI / 180;

// A track through the three views: the set omega of the paper.
struct Track3 {
  const PointObservation* first = nullptr;   // in t-2
  const PointObservation* middle = nullptr;  // in t-1
  const PointObservation* last = nullptr;    // in t
};

// Poses in L of t-2 and t, and the inverse depths of the tracks from t-1; L is the camera frame of t-1.
struct LocalStructure {
  bool usable = false;
  std::string reason;
  Pose local_T_first;
  Pose local_T_last;
  std::vector<double> inverse_depths;  // one a track; 0: none
  std::vector<double> depth_sigmas;
  std::vector<char> inliers;  // one a track
  std::vector<char> misfits;  // likewise: not those that only lack a depth
  int inlier_count = 0;
};

std::vector<Track3> commonTracks(const Keyframe& first, const Keyframe& middle, const TrackedFrame& last) {
  std::map<PointId, Track3> tracks;
  for (const PointObservation& observation : last.observations) {
    const PointObservation* in_middle = findObservation(middle, observation.point);
    const PointObservation* in_first = findObservation(first, observation.point);
    if (in_middle && in_first) tracks[observation.point] = {in_first, in_middle, &observation};
  }
  std::vector<Track3> common;
  common.reserve(tracks.size());
  for (const auto& [id, track] : tracks) common.push_back(track);
  return common;
}

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Median angle under which the inliers see t-1 and a camera with its centre at `centre` (L).
double medianParallax(const std::vector<Track3>& tracks, const LocalStructure& local, const Eigen::Vector3d& centre) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!local.inliers[i]) continue;
    const Eigen::Vector3d point = tracks[i].middle->bearing / local.inverse_depths[i];
    angles.push_back(angleBetween(point, point - centre));
  }
  return angles.empty() ? 0 : upperMedian(angles);
}

PoseObservations observationsInFirst(const std::vector<Track3>& tracks, const LocalStructure& local,
                                     const std::vector<char>& taken) {
  PoseObservations observations;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!taken[i]) continue;
    PoseObservation observation;
    observation.point = tracks[i].middle->bearing / local.inverse_depths[i];
    observation.measurement = tracks[i].first->measurement;
    observations.push_back(observation);
  }
  return observations;
}

// Epipolar geometry between t-1 and t: rotation and unit direction. `corners_only`: from points known in both
// directions, as points of edges may have slid.
RelativePose epipolarPose(const Camera& camera, const std::vector<Track3>& tracks, bool corners_only,
                          const RecoveryOptions& options) {
  std::vector<Eigen::Vector3d> middle, last;
  for (const Track3& track : tracks) {
    if (corners_only && !(track.middle->corner && track.last->corner)) continue;
    middle.push_back(track.middle->bearing);
    last.push_back(track.last->bearing);
  }
  return relativePose(middle, last, options.epipolar_error / meanFocalLength(camera), /*seed=*/1);
}

void triangulateTracks(const Camera& camera, const std::vector<Track3>& tracks, const Pose& last_T_local,
                       LocalStructure& local) {
  local.inverse_depths.assign(tracks.size(), 0.0);
  local.depth_sigmas.assign(tracks.size(), 0.0);
  local.inliers.assign(tracks.size(), 0);
  local.misfits.assign(tracks.size(), 0);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const TriangulationResult point =
        triangulate(camera, tracks[i].middle->bearing, {{last_T_local, tracks[i].last->measurement}});
    if (!point.converged || !(point.inverse_depth > 0) || point.sigma > 0.5 * point.inverse_depth) continue;
    local.inverse_depths[i] = point.inverse_depth;
    local.depth_sigmas[i] = point.sigma;
    local.inliers[i] = 1;
  }
}

// t-2 in L, by EPnP, and by least squares on the edges' measurements; from its known rotation where EPnP finds nothing.
bool resectionFirst(const Camera& camera, const std::vector<Track3>& tracks, const Pose& known_middle_T_first,
                    const RecoveryOptions& options, LocalStructure& local) {
  Vectors3 points, bearings;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!local.inliers[i]) continue;
    points.emplace_back(tracks[i].middle->bearing / local.inverse_depths[i]);
    bearings.push_back(tracks[i].first->bearing);
  }
  const ResectioningResult resectioned =
      resection(points, bearings, options.resectioning_error / meanFocalLength(camera), /*seed=*/1);
  const PoseObservations observations = observationsInFirst(tracks, local, local.inliers);
  const Pose only_turned{known_middle_T_first.rotation, Eigen::Vector3d::Zero()};
  PoseResult best = adjustPose(camera, only_turned, observations, PoseOptions());
  if (resectioned.found) {
    const PoseResult from_epnp = adjustPose(camera, resectioned.camera_T_world.inverse(), observations, PoseOptions());
    if (from_epnp.converged && (!best.converged || from_epnp.inlier_count > best.inlier_count)) best = from_epnp;
  }
  local.local_T_first = best.world_T_camera;
  return best.converged;
}

// Bundle adjustment of t-2, t and the points with t-1 fixed and the distance of t kept; then once more without
// outliers.
bool adjustLocal(const Camera& camera, const std::vector<Track3>& tracks, const RecoveryOptions& options,
                 LocalStructure& local) {
  for (int round = 0; round < 2; ++round) {
    BundleProblem problem;
    problem.cameras = {{Pose(), true}, {local.local_T_first, false}, {local.local_T_last, false}};
    problem.scale_camera = 2;
    std::vector<std::size_t> track_of_point;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      if (!local.inliers[i]) continue;
      const auto point = static_cast<int>(problem.points.size());
      BundlePoint unknown;
      unknown.host_bearing = tracks[i].middle->bearing;
      unknown.inverse_depth = local.inverse_depths[i];
      problem.points.push_back(unknown);
      problem.observations.push_back({1, point, tracks[i].first->measurement});
      problem.observations.push_back({2, point, tracks[i].last->measurement});
      track_of_point.push_back(i);
    }
    const BundleResult result = adjustBundle(camera, problem, options.bundle);
    if (!result.usable) return false;
    local.local_T_first = problem.cameras[1].world_T_camera;
    local.local_T_last = problem.cameras[2].world_T_camera;
    local.inlier_count = 0;
    for (std::size_t p = 0; p < track_of_point.size(); ++p) {
      const std::size_t i = track_of_point[p];
      local.inverse_depths[i] = problem.points[p].inverse_depth;
      local.depth_sigmas[i] = result.depth_sigmas[p];
      const bool fits = result.errors[2 * p] < options.outlier && result.errors[2 * p + 1] < options.outlier;
      const bool has_depth = local.depth_sigmas[i] < options.largest_depth_sigma * local.inverse_depths[i];
      if (!fits) local.misfits[i] = 1;
      // Points of uncertain depth still hold the rotation in the second round; they only don't count as structure.
      local.inliers[i] = fits && (has_depth || round == 0) ? 1 : 0;
      local.inlier_count += local.inliers[i];
    }
    if (local.inlier_count < options.fewest_tracks / 2) return false;
  }
  return true;
}

// Empty where L is to be trusted. What is known of t-2 and t-1 judges it: its structure must give their relative pose
// again.
std::string reasonToRefuse(const std::vector<Track3>& tracks, const LocalStructure& local,
                           const Pose& known_middle_T_first, const RecoveryOptions& options) {
  const double needed =
      std::min<double>(options.fewest_inliers, options.inlier_share * static_cast<double>(tracks.size()));
  if (local.inlier_count <= needed) {
    return "only " + std::to_string(local.inlier_count) + " of " + std::to_string(tracks.size()) +
           " tracks fit the three views";
  }
  if (medianParallax(tracks, local, local.local_T_last.translation) < options.least_parallax_deg * degree) {
    return "too little parallax between the last keyframe and the frame";
  }
  if (medianParallax(tracks, local, local.local_T_first.translation) < options.least_parallax_deg * degree) {
    return "too little parallax between the last two keyframes";
  }
  if (rotationAngle(local.local_T_first.rotation, known_middle_T_first.rotation) >
          options.rotation_difference_deg * degree ||
      angleBetween(local.local_T_first.translation, known_middle_T_first.translation) >
          options.direction_difference_deg * degree) {
    return "the three views' own structure contradicts the last two keyframes' poses";
  }
  return "";
}

LocalStructure reconstruct(const Camera& camera, const std::vector<Track3>& tracks, const Pose& known_middle_T_first,
                           bool corners_only, const RecoveryOptions& options) {
  LocalStructure local;
  const RelativePose epipolar = epipolarPose(camera, tracks, corners_only, options);
  if (!epipolar.found || epipolar.parallax < options.least_parallax_deg * degree) {
    local.reason = epipolar.rotation_only_share > 0.9 || epipolar.found
                       ? "too little parallax between the last keyframe and the frame"
                       : "no epipolar geometry between the last keyframe and the frame";
    return local;
  }
  local.local_T_last = epipolar.second_T_first.inverse();
  triangulateTracks(camera, tracks, epipolar.second_T_first, local);
  if (!resectionFirst(camera, tracks, known_middle_T_first, options, local)) {
    local.reason = "the keyframe before the last does not fit the new structure";
    return local;
  }
  if (!adjustLocal(camera, tracks, options, local)) {
    local.reason = "the three views' structure could not be adjusted";
    return local;
  }
  local.reason = reasonToRefuse(tracks, local, known_middle_T_first, options);
  local.usable = local.reason.empty();
  return local;
}

// Eq. 2; the centre of t-1 in L is the origin.
double scaleFromCentres(const Pose& world_T_first, const Pose& world_T_middle, const LocalStructure& local) {
  return (world_T_middle.translation - world_T_first.translation).norm() / local.local_T_first.translation.norm();
}

// Eqs. 3 to 7, with camera-to-world rotations: the paper's R is their inverse.
Pose carryOver(const Pose& world_T_middle, const Pose& local_T_last, double scale) {
  const Eigen::Vector3d scaled_centre = scale * local_T_last.translation;  // eq. 3
  const Eigen::Vector3d rotated_centre =
      world_T_middle.rotation.conjugate() * world_T_middle.translation + scaled_centre;  // eq. 4
  const Eigen::Vector3d centre = world_T_middle.rotation * rotated_centre;               // eq. 5
  return {(world_T_middle.rotation * local_T_last.rotation).normalized(), centre};       // eqs. 6, 7
}

// Standard deviation of the scale, share of it: how well the structure tells how far t-2 is along its direction.
double scaleSigma(const Camera& camera, const std::vector<Track3>& tracks, const LocalStructure& local) {
  const PoseResult first =
      adjustPose(camera, local.local_T_first, observationsInFirst(tracks, local, local.inliers), PoseOptions());
  if (!first.converged) return std::numeric_limits<double>::infinity();
  const Eigen::Vector3d direction =
      (first.world_T_camera.rotation.conjugate() * local.local_T_first.translation).normalized();
  return std::sqrt(std::max(0.0, direction.dot(first.covariance.topLeftCorner<3, 3>() * direction))) /
         local.local_T_first.translation.norm();
}

// Of the pose of t: from its own measurements of the points, and from the scale.
Matrix6d covarianceOfLast(const Camera& camera, const std::vector<Track3>& tracks, const LocalStructure& local,
                          const RecoveryResult& result, const Pose& world_T_middle, double scale_sigma) {
  PoseObservations observations;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!local.inliers[i]) continue;
    PoseObservation observation;
    observation.point =
        world_T_middle * Eigen::Vector3d(tracks[i].middle->bearing * (result.scale / local.inverse_depths[i]));
    observation.measurement = tracks[i].last->measurement;
    observations.push_back(observation);
  }
  Matrix6d covariance = adjustPose(camera, result.world_T_camera, observations, PoseOptions()).covariance;
  const Eigen::Vector3d moved =
      result.world_T_camera.rotation.conjugate() * (result.world_T_camera.translation - world_T_middle.translation);
  covariance.topLeftCorner<3, 3>() += scale_sigma * scale_sigma * moved * moved.transpose();
  return covariance;
}

}  // namespace

RecoveryResult recoverTrackLoss(const Camera& camera, const Keyframe& t_minus_2, const Keyframe& t_minus_1,
                                const TrackedFrame& t, const RecoveryOptions& presumed) {
  RecoveryOptions options = presumed;
  options.epipolar_error *= t.noise_factor;
  options.resectioning_error *= t.noise_factor;
  RecoveryResult result;
  const std::vector<Track3> tracks = commonTracks(t_minus_2, t_minus_1, t);
  result.tracks = static_cast<int>(tracks.size());
  if (result.tracks < options.fewest_tracks) {
    result.reason =
        "only " + std::to_string(result.tracks) + " tracks run through the last two keyframes and the frame";
    return result;
  }
  const Pose known_middle_T_first = t_minus_1.world_T_camera.inverse() * t_minus_2.world_T_camera;
  LocalStructure local = reconstruct(camera, tracks, known_middle_T_first, /*corners_only=*/false, options);
  LocalStructure by_corners = reconstruct(camera, tracks, known_middle_T_first, /*corners_only=*/true, options);
  const bool corners_win =
      by_corners.usable != local.usable ? by_corners.usable : by_corners.inlier_count > local.inlier_count;
  if (corners_win) local = std::move(by_corners);
  result.inliers = local.inlier_count;
  if (!local.usable) {
    result.reason = local.reason;
    return result;
  }
  const double scale_sigma = scaleSigma(camera, tracks, local);
  if (!(scale_sigma < options.largest_scale_sigma)) {
    result.reason = "the scale is too uncertain";
    return result;
  }

  result.found = true;
  result.scale = scaleFromCentres(t_minus_2.world_T_camera, t_minus_1.world_T_camera, local);
  result.world_T_camera = carryOver(t_minus_1.world_T_camera, local.local_T_last, result.scale);
  result.covariance = covarianceOfLast(camera, tracks, local, result, t_minus_1.world_T_camera, scale_sigma);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (local.misfits[i]) result.misfits.push_back(tracks[i].middle->point);
    if (!local.inliers[i]) continue;
    const PointObservation& host = *tracks[i].middle;
    result.points.push_back({host.point, host.bearing, local.inverse_depths[i] / result.scale,
                             local.depth_sigmas[i] / result.scale, host.corner, host.chain, host.order});
  }
  return result;
}

void leaveOutContradictions(const Camera& camera, const Map& map, const RecoveryResult& found, double largest_miss,
                            std::vector<PointObservation>& observations) {
  const CameraFrame frame = cameraFrame(found.world_T_camera);
  const auto contradicts = [&](const PointObservation& seen) {
    if (std::binary_search(found.misfits.begin(), found.misfits.end(), seen.point)) return true;
    const auto point = map.points.find(seen.point);
    if (point == map.points.end()) return false;
    Eigen::Vector2d residual;
    const bool is_in_front = poseResidual(camera, {seen.measurement.pixel, whitening(seen.measurement)}, frame,
                                          worldPosition(map, point->second), residual, nullptr);
    return !is_in_front || residual.norm() > largest_miss;
  };
  observations.erase(std::remove_if(observations.begin(), observations.end(), contradicts), observations.end());
}

}  // namespace edgeslam
