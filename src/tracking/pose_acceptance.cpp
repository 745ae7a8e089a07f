#include "tracking/pose_acceptance.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {

int fewestInliers(std::size_t in_view, const AcceptanceContext& context, const AcceptanceOptions& options) {
  const auto visible = static_cast<double>(in_view), before = static_cast<double>(context.inliers_before);
  double fewest = std::max(options.least_inlier_share * visible, options.least_points_share * before);
  fewest = std::max<double>(fewest, options.fewest_points);
  if (context.regains) {
    const double most_of_them =
        std::max(options.regain_inlier_share * visible, options.regain_fewest_points_share * before);
    const double as_many_as_before = options.regain_points_share * before;
    fewest = std::max(fewest, std::min(most_of_them, as_many_as_before));
  }
  return static_cast<int>(std::ceil(fewest));
}

bool isLeap(const FramePose& pose, const AcceptanceContext& context, const AcceptanceOptions& options) {
  if (!context.knows_motion || context.followed_share >= options.leap_followed_share) return false;
  const Pose off = context.world_T_predicted.inverse() * pose.result.world_T_camera;
  const double farthest = options.leap_speed * context.seconds;
  return off.translation.norm() > farthest * context.scene_depth ||
         rotationAngle(off.rotation, Eigen::Quaterniond::Identity()) > farthest;
}

bool isBelieved(const FramePose& pose, const AcceptanceContext& context, const AcceptanceOptions& options) {
  return pose.result.inlier_count >= fewestInliers(pose.track_of_observation.size(), context, options) &&
         largestDeviation(pose.result.covariance, context.scene_depth) < options.largest_deviation &&
         !isLeap(pose, context, options);
}

}  // namespace edgeslam
