// What happens, a line an event, to the standard error (the journal of a service), and never a flood.
#pragma once

#include <chrono>
#include <mutex>
#include <ostream>
#include <string>

#include "service/outside_thread.h"

namespace edgeslam {

// For all threads; never waits for whoever reads. `stream` outlives the program's end (std::cerr does).
class EventLog {
 public:
  using Clock = std::chrono::steady_clock;

  explicit EventLog(std::ostream& stream) : stream_(stream) {}

  // "edgeslam: LINE". Of more than most_lines in window_s the rest is counted, and the number told later.
  void tell(const std::string& line) { tell(line, Clock::now()); }
  void tell(const std::string& line, Clock::time_point now);

  // Whether all that was told is out within `OutsideThread::patience`.
  bool waitUntilOut() { return outside_.waitUntilTaken(); }

  static constexpr int most_lines = 20;
  static constexpr int window_s = 10;

 private:
  std::mutex mutex_;
  std::ostream& stream_;
  Clock::time_point window_start_{};
  int lines_ = 0, left_out_ = 0;  // in this window
  OutsideThread outside_;
};

}  // namespace edgeslam
