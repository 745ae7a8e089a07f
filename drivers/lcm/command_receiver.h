// The robot's commands as they come in, checked.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "drivers/lcm/commands.h"
#include "drivers/lcm/lcm_listener.h"

namespace edgeslam {

class CommandReceiver {
 public:
  // `url` from effectiveUrl(), one that canReceive().
  CommandReceiver(std::string url, std::string channel);

  // The oldest that waits, or none. One thread's alone.
  std::optional<CheckedCommand> next();

  // Messages that were no command, and commands for which the queue was full.
  std::int64_t ignored() const { return ignored_.load(std::memory_order_relaxed); }
  LcmListener& listener() { return listener_; }
  const LcmListener& listener() const { return listener_; }

 private:
  void take(const void* data, std::size_t bytes);

  boost::lockfree::spsc_queue<CheckedCommand, boost::lockfree::capacity<16>> waiting_;
  std::atomic<std::int64_t> ignored_{0};
  LcmListener listener_;  // last: its thread uses the others
};

}  // namespace edgeslam
