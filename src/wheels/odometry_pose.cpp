#include "wheels/odometry_pose.h"

#include <cmath>

namespace edgeslam {

bool isUsable(const OdometryPose& pose) {
  constexpr double farthest_m = 1e7, largest_norm_error = 1e-6;
  constexpr std::int64_t latest_utime = 4'000'000'000'000'000;
  const Eigen::Vector3d& position = pose.local_T_body.translation;
  const Eigen::Quaterniond& turn = pose.local_T_body.rotation;
  return pose.utime >= 0 && pose.utime <= latest_utime && position.allFinite() &&
         position.cwiseAbs().maxCoeff() <= farthest_m && turn.coeffs().allFinite() &&
         std::abs(turn.norm() - 1) <= largest_norm_error;
}

}  // namespace edgeslam
