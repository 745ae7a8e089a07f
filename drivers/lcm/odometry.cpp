#include "drivers/lcm/odometry.h"

#include <cmath>

#include "edgeslam/pose_t.hpp"

namespace edgeslam {
namespace {

constexpr double largest_norm_error = 0.01;

}  // namespace

std::optional<OdometryPose> checkOdometry(const void* data, std::size_t bytes) {
  pose_t message;
  const int expected = message.getEncodedSize();
  if (bytes != static_cast<std::size_t>(expected) || message.decode(data, 0, expected) != expected) return std::nullopt;
  const Eigen::Map<const Eigen::Vector3d> position(message.pos);
  const Eigen::Map<const Eigen::Vector4d> turn(message.orientation);
  if (!(std::abs(turn.norm() - 1) <= largest_norm_error)) return std::nullopt;
  OdometryPose pose;
  pose.utime = message.utime;
  pose.local_T_body = {Eigen::Quaterniond(turn[0], turn[1], turn[2], turn[3]).normalized(), position};
  return isUsable(pose) ? std::optional(pose) : std::nullopt;
}

}  // namespace edgeslam
