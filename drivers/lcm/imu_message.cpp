#include "drivers/lcm/imu_message.h"

#include "edgeslam/imu_t.hpp"
#include "inertia/inertial_history.h"

namespace edgeslam {
namespace {

constexpr std::int64_t latest_utime = 4'000'000'000'000'000;  // [us]: the year 2096, as of odometry

}  // namespace

std::optional<InertialSample> checkImu(const void* data, std::size_t bytes) {
  imu_t message;
  const int expected = message.getEncodedSize();
  if (bytes != static_cast<std::size_t>(expected) || message.decode(data, 0, expected) != expected) return std::nullopt;
  if (message.utime < 0 || message.utime > latest_utime) return std::nullopt;
  InertialSample sample;
  sample.time_ns = message.utime * 1000;
  sample.rate = Eigen::Map<const Eigen::Vector3d>(message.rotation_rate);
  sample.force = Eigen::Map<const Eigen::Vector3d>(message.specific_force);
  return isUsable(sample) ? std::optional(sample) : std::nullopt;
}

}  // namespace edgeslam
