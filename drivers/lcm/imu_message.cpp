#include "drivers/lcm/imu_message.h"

#include "edgeslam/imu_t.hpp"
#include "edgeslam/ins_t.hpp"
#include "inertia/inertial_history.h"

namespace edgeslam {
namespace {

constexpr std::int64_t latest_utime = 4'000'000'000'000'000;  // [us]: the year 2096, as of odometry

// None where the bytes are no message of this type.
template <typename Message>
std::optional<Message> decoded(const void* data, std::size_t bytes) {
  Message message;
  const int expected = message.getEncodedSize();
  if (bytes != static_cast<std::size_t>(expected) || message.decode(data, 0, expected) != expected) return std::nullopt;
  return message;
}

std::optional<InertialSample> usableSample(std::int64_t utime, const double (&rate)[3], const double (&force)[3]) {
  if (utime < 0 || utime > latest_utime) return std::nullopt;
  InertialSample sample;
  sample.time_ns = utime * 1000;
  sample.rate = Eigen::Map<const Eigen::Vector3d>(rate);
  sample.force = Eigen::Map<const Eigen::Vector3d>(force);
  return isUsable(sample) ? std::optional(sample) : std::nullopt;
}

}  // namespace

std::optional<InertialSample> checkImu(const void* data, std::size_t bytes) {
  if (const auto message = decoded<imu_t>(data, bytes)) {
    return usableSample(message->utime, message->rotation_rate, message->specific_force);
  }
  if (const auto message = decoded<ins_t>(data, bytes)) {
    return usableSample(message->utime, message->gyro, message->accel);
  }
  return std::nullopt;
}

}  // namespace edgeslam
