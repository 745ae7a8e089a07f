// The two clocks of the messages.
#pragma once

#include <chrono>
#include <cstdint>

namespace edgeslam {

// CLOCK_MONOTONIC [us], the clock of the camera drivers.
inline std::int64_t monotonicUtime() {
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// CLOCK_REALTIME [us].
inline std::int64_t realUtime() {
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace edgeslam
