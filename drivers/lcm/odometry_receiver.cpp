#include "drivers/lcm/odometry_receiver.h"

#include <utility>

namespace edgeslam {

OdometryReceiver::OdometryReceiver(std::string url, std::string channel)
    : listener_(std::move(url), std::move(channel), "odometry",
                [this](const void* data, std::size_t bytes) { take(data, bytes); }) {}

std::optional<OdometryPose> OdometryReceiver::next() {
  OdometryPose pose;
  if (!waiting_.pop(pose)) return std::nullopt;
  return pose;
}

void OdometryReceiver::take(const void* data, std::size_t bytes) {
  const std::optional<OdometryPose> pose = checkOdometry(data, bytes);
  if (!pose || !waiting_.push(*pose)) ignored_.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace edgeslam
