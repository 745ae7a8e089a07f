// The time stamp of a driver's buffer.
#pragma once

#include <linux/videodev2.h>

#include <cstdint>
#include <optional>

#include "drivers/frame_capture/exposure_middle.h"

namespace edgeslam {

// Nothing where it is of another clock than CLOCK_MONOTONIC, or no time at all. A driver that does not name its clock
// (v4l2loopback) is believed; exposure_middle.h checks that the time can be. `flags`: V4L2_BUF_FLAG_TIMESTAMP_...
inline std::optional<DriverStamp> stampOfBuffer(std::uint32_t flags, std::int64_t seconds, std::int64_t microseconds) {
  const std::uint32_t clock = flags & V4L2_BUF_FLAG_TIMESTAMP_MASK;
  if (clock != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC && clock != V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN) return std::nullopt;
  constexpr std::int64_t latest_s = 4'000'000'000;  // beyond it, nanoseconds would not fit
  if (seconds < 0 || seconds > latest_s || microseconds < 0 || microseconds >= 1'000'000) return std::nullopt;
  const bool start = (flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  return DriverStamp{seconds * 1'000'000'000 + microseconds * 1000,
                     start ? TimeMeaning::exposure_start : TimeMeaning::exposure_end};
}

}  // namespace edgeslam
