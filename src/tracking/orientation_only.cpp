#include "tracking/orientation_only.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/squared.h"
#include "tracking/pose_observations.h"

namespace edgeslam {
namespace {

// Where the camera was, and how far it may have moved since.
PosePrior heldPosition(const HeldCamera& held, double sigma) {
  const Eigen::Matrix3d known = held.covariance.topLeftCorner<3, 3>();
  PosePrior prior{held.world_T_last};
  prior.information.topLeftCorner<3, 3>() = (known + squared(sigma) * Eigen::Matrix3d::Identity()).inverse();
  return prior;
}

double largestDeviationOf(const Eigen::Matrix3d& covariance) {
  Matrix6d alone = Matrix6d::Zero();
  alone.topLeftCorner<3, 3>() = covariance;
  return largestDeviation(alone, 1);
}

// Before what is not mapped is taken out of the pose.
bool isBelieved(const FramePose& pose, double scene_depth, const OrientationOnlyOptions& options) {
  if (!pose.result.converged) return false;
  const std::pmr::vector<double>& errors = pose.result.errors_across;
  const auto mapped = static_cast<std::ptrdiff_t>(pose.track_of_observation.size());
  const auto turned = std::count_if(errors.begin() + mapped, errors.end(), [](double e) { return std::abs(e) < 1; });
  const auto agree = std::count(pose.result.inliers.begin(), pose.result.inliers.begin() + mapped, 1);
  const auto unmapped = static_cast<double>(errors.size()) - static_cast<double>(mapped);
  const Matrix6d& covariance = pose.result.covariance;
  return static_cast<double>(turned) >= options.least_share * unmapped &&
         static_cast<double>(agree) >= options.least_map_share * static_cast<double>(mapped) &&
         largestDeviationOf(covariance.topLeftCorner<3, 3>()) < options.largest_position_deviation * scene_depth &&
         largestDeviationOf(covariance.bottomRightCorner<3, 3>()) < options.largest_rotation_deviation;
}

}  // namespace

std::optional<FramePose> orientationOnly(const Camera& camera, const MapView& view, const std::vector<Track>& tracks,
                                         const HeldCamera& held, const FramePoseOptions& pose_options,
                                         const OrientationOnlyOptions& options, std::pmr::memory_resource* memory,
                                         const RowMotion& motion) {
  if (!options.enabled || held.seconds_ago > options.longest_gap_s) return std::nullopt;
  if (static_cast<int>(tracks.size()) < options.fewest_tracks) return std::nullopt;
  if (held.followed_share < options.least_followed_share) return std::nullopt;
  const Pose start{held.world_R_camera, held.world_T_last.translation};
  const double moved_depths = options.speed * held.seconds_ago;
  FramePose pose(memory);
  PoseObservations observations(memory);
  observations.reserve(tracks.size());
  pose.track_of_observation.reserve(tracks.size());
  addMapped(camera, view, tracks, start.inverse(), observations, pose.track_of_observation);
  const UnmappedTracks presumed{1 / held.scene_depth, 1 / held.scene_depth, 1, moved_depths * meanFocalLength(camera)};
  addUnmapped(camera, view, tracks, start.inverse(), presumed, observations);
  if (static_cast<int>(observations.size()) < options.fewest_tracks) return std::nullopt;
  pose.result = adjustPose(camera, start, observations, pose_options, memory, motion,
                           heldPosition(held, moved_depths * held.scene_depth));
  if (!isBelieved(pose, held.scene_depth, options)) return std::nullopt;
  keepMapped(pose);
  return std::optional<FramePose>(std::move(pose));
}

}  // namespace edgeslam
