// Waits for what other threads and processes do.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace edgeslam {

// Asks until it is so, or for so long; for what happens soon, on a loaded machine, too.
inline bool comesTrue(const std::function<bool()>& condition, double seconds = 30) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

}  // namespace edgeslam
