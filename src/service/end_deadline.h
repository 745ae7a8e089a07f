// The end of a daemon whose disk may not let it go: recordings and the map are waited for, but not for ever.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

#include "service/event_log.h"

namespace edgeslam {

// Ends the program with exit_failed and a line in the log where it takes too long to end by itself: from begin() on, or
// from when SIGTERM or SIGINT waits to be taken, blocked as DaemonSignals leaves them. Only the time in which the
// program waits is counted, not that of its own work, which a large map takes.
class EndDeadline {
 public:
  // Of waiting, all together. systemd kills the service after more than that (TimeoutStopSec).
  static constexpr auto longest_wait = std::chrono::seconds(10);

  // `log` outlives it.
  explicit EndDeadline(EventLog& log, std::chrono::nanoseconds patience = longest_wait);
  // The program has come to its end in time.
  ~EndDeadline();
  EndDeadline(const EndDeadline&) = delete;
  EndDeadline& operator=(const EndDeadline&) = delete;
  EndDeadline(EndDeadline&&) = delete;
  EndDeadline& operator=(EndDeadline&&) = delete;

  void begin();

 private:
  void watch();

  EventLog& log_;
  const std::chrono::nanoseconds patience_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool begun_ = false, stopping_ = false;
  std::thread thread_;
};

}  // namespace edgeslam
