// The middle of the exposure of a frame's middle row, from what its driver and the calibration tell.
#pragma once

#include <cmath>
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

// From the reading of the row that is read first, or last, to the middle one's: the same where rows are read from
// below. 0 where no readout is known.
inline std::int64_t halfOfReadout(double readout_s) {
  const double whole_s = std::abs(readout_s);
  return whole_s <= 0.2 ? std::llround(0.5e9 * whole_s) : 0;
}

// The driver's stamp is taken at the start of the first row's exposure, or once the last row was read, which ends its
// exposure. So the middle row's start is half the readout later, its end half the readout earlier. Half the exposure
// further is the middle, where the exposure time is known and shorter than 1 s.
inline FrameTime middleOfExposure(const std::optional<DriverStamp>& stamp, std::int64_t exposure_ns, double readout_s,
                                  std::int64_t arrival_ns) {
  if (!stamp || stamp->time_ns < arrival_ns - oldest_stamp_ns || stamp->time_ns > arrival_ns + furthest_ahead_ns) {
    return {arrival_ns, TimeMeaning::arrival};
  }
  const bool known = exposure_ns > 0 && exposure_ns < 1'000'000'000;
  const std::int64_t shift_ns = halfOfReadout(readout_s) + (known ? exposure_ns / 2 : 0);
  const TimeMeaning meaning = known ? TimeMeaning::exposure_middle : stamp->meaning;
  if (stamp->meaning == TimeMeaning::exposure_start) return {stamp->time_ns + shift_ns, meaning};
  if (stamp->meaning == TimeMeaning::exposure_end) return {stamp->time_ns - shift_ns, meaning};
  return {stamp->time_ns, stamp->meaning};
}

}  // namespace edgeslam
