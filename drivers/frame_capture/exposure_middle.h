// The middle of a frame's exposure from what its driver tells.
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/frame_capture/live_camera.h"

namespace edgeslam {

struct DriverStamp {
  std::int64_t time_ns = 0;  // CLOCK_MONOTONIC
  TimeMeaning meaning = TimeMeaning::exposure_start;
};

struct FrameTime {
  std::int64_t time_ns = 0;
  TimeMeaning meaning = TimeMeaning::arrival;
};

// A stamp counts where it is at most `oldest` before the frame's arrival and not more than `ahead` after it: some
// drivers fill in another clock or nothing at all. Otherwise the time of arrival is all that is known.
constexpr std::int64_t oldest_stamp_ns = 5'000'000'000;
constexpr std::int64_t furthest_ahead_ns = 200'000'000;

// Half the exposure after its start, or before its end, where the exposure time is known and shorter than 1 s.
inline FrameTime middleOfExposure(const std::optional<DriverStamp>& stamp, std::int64_t exposure_ns,
                                  std::int64_t arrival_ns) {
  if (!stamp || stamp->time_ns < arrival_ns - oldest_stamp_ns || stamp->time_ns > arrival_ns + furthest_ahead_ns) {
    return {arrival_ns, TimeMeaning::arrival};
  }
  const bool known = exposure_ns > 0 && exposure_ns < 1'000'000'000;
  if (known && stamp->meaning == TimeMeaning::exposure_start) {
    return {stamp->time_ns + exposure_ns / 2, TimeMeaning::exposure_middle};
  }
  if (known && stamp->meaning == TimeMeaning::exposure_end) {
    return {stamp->time_ns - exposure_ns / 2, TimeMeaning::exposure_middle};
  }
  return {stamp->time_ns, stamp->meaning};
}

}  // namespace edgeslam
