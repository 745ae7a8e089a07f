// Time stamps as ROS 2 has them, of CLOCK_REALTIME, from those of the frames.
#pragma once

#include <cstdint>
#include <optional>

namespace edgeslam {

// A live camera's frames are of CLOCK_MONOTONIC: what the two clocks differ by is added. It changes only where the time
// of day is set anew. A recording's own time stamps go on from the time of day at which its first frame is published,
// so that transforms are of now for whoever listens.
class RosClock {
 public:
  // [us]: the frame's time stamp, and the two clocks now. Nanoseconds.
  std::int64_t stamp_ns(std::int64_t utime, std::int64_t real_utime, std::int64_t monotonic_utime);

 private:
  std::optional<std::int64_t> offset_us_;
  std::optional<std::int64_t> other_offset_us_;  // that was seen with the frame before, and not taken yet
};

}  // namespace edgeslam
