#include "drivers/ros2/ros_clock.h"

#include <cstdlib>

namespace edgeslam {
namespace {

constexpr std::int64_t longest_latency_us = 10'000'000;  // of a live camera's frame; others are of a recording
// The two clocks are not read at the same moment: a smaller difference is none, and a larger one counts where it is
// seen twice.
constexpr std::int64_t least_step_us = 1000;

}  // namespace

std::int64_t RosClock::stamp_ns(std::int64_t utime, std::int64_t real_utime, std::int64_t monotonic_utime) {
  const bool is_live = std::abs(utime - monotonic_utime) <= longest_latency_us;
  const std::int64_t offset = is_live ? real_utime - monotonic_utime : real_utime - utime;
  const std::int64_t tolerated = is_live ? least_step_us : longest_latency_us;
  if (!offset_us_) offset_us_ = offset;
  if (std::abs(offset - *offset_us_) <= tolerated) {
    other_offset_us_.reset();
  } else if (other_offset_us_ && std::abs(offset - *other_offset_us_) <= tolerated) {
    offset_us_ = offset;
    other_offset_us_.reset();
  } else {
    other_offset_us_ = offset;
  }
  return 1000 * (utime + *offset_us_);
}

}  // namespace edgeslam
