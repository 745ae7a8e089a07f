// The robot's wheel odometry as it comes in, checked message by message.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "drivers/lcm/lcm_listener.h"
#include "drivers/lcm/odometry.h"

namespace edgeslam {

class OdometryReceiver {
 public:
  // `url` from effectiveUrl(), one that canReceive().
  OdometryReceiver(std::string url, std::string channel);

  // The oldest that waits, or none. One thread's alone.
  std::optional<OdometryPose> next();

  // Messages that were no pose, and poses for which the queue was full (over 1 s at 1000 a second).
  std::int64_t ignored() const { return ignored_.load(std::memory_order_relaxed); }
  LcmListener& listener() { return listener_; }

 private:
  void take(const void* data, std::size_t bytes);

  boost::lockfree::spsc_queue<OdometryPose, boost::lockfree::capacity<1024>> waiting_;
  std::atomic<std::int64_t> ignored_{0};
  LcmListener listener_;  // last: its thread uses the others
};

}  // namespace edgeslam
