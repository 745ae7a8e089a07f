// How far a replay is, for the person who waits for it.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <iostream>
#include <string>

#include "files/format_text.h"

namespace edgeslam {

// "frame 120 of 780, tracking, 3.1 x real time": rewritten in place on a terminal, a line every ten seconds elsewhere.
class ReplayProgress {
 public:
  explicit ReplayProgress(std::int64_t total)
      : total_(total), terminal_(isatty(STDERR_FILENO) == 1), start_(now()), last_(start_) {}

  template <typename Frame>
  void show(const Frame& frame, std::int64_t count, double sequence_s) {
    const double elapsed = now() - last_;
    if (elapsed < (terminal_ ? 0.1 : 10.0)) return;
    last_ = now();
    std::string line = "frame " + std::to_string(count) + (total_ > 0 ? " of " + std::to_string(total_) : "") + ", " +
                       stateName(frame.state) + (frame.reason.empty() ? "" : " (" + frame.reason + ")");
    line += formatted(", %.1f x real time", sequence_s / (last_ - start_));
    if (terminal_) {
      std::cerr << "\r\033[K" << line << std::flush;
    } else {
      std::cerr << line << "\n";
    }
  }

  void end() const {
    if (terminal_) std::cerr << "\r\033[K" << std::flush;
  }

 private:
  static double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

  std::int64_t total_;
  bool terminal_;
  double start_, last_;
};

}  // namespace edgeslam
