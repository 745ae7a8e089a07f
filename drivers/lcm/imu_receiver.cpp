#include "drivers/lcm/imu_receiver.h"

#include <utility>

namespace edgeslam {

ImuReceiver::ImuReceiver(std::string url, std::string channel)
    : listener_(std::move(url), std::move(channel), "imu",
                [this](const void* data, std::size_t bytes) { take(data, bytes); }) {}

std::optional<InertialSample> ImuReceiver::next() {
  InertialSample sample;
  if (!waiting_.pop(sample)) return std::nullopt;
  return sample;
}

void ImuReceiver::take(const void* data, std::size_t bytes) {
  const std::optional<InertialSample> sample = checkImu(data, bytes);
  if (!sample || !waiting_.push(*sample)) ignored_.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace edgeslam
