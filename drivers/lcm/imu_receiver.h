// What the robot's inertial unit measures as it comes in, checked message by message.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "drivers/lcm/imu_message.h"
#include "drivers/lcm/lcm_listener.h"

namespace edgeslam {

class ImuReceiver {
 public:
  // `url` from effectiveUrl(), one that canReceive().
  ImuReceiver(std::string url, std::string channel);

  // The oldest that waits, or none. One thread's alone.
  std::optional<InertialSample> next();

  // Messages that were nothing of a unit's, and those for which the queue was full (over 2 s at 2000 a second).
  std::int64_t ignored() const { return ignored_.load(std::memory_order_relaxed); }
  LcmListener& listener() { return listener_; }

 private:
  void take(const void* data, std::size_t bytes);

  boost::lockfree::spsc_queue<InertialSample, boost::lockfree::capacity<4096>> waiting_;
  std::atomic<std::int64_t> ignored_{0};
  LcmListener listener_;  // last: its thread uses the others
};

}  // namespace edgeslam
