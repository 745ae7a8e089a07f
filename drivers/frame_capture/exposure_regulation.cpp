#include "drivers/frame_capture/exposure_regulation.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {
namespace {

constexpr double wanted_mean = 110;
constexpr double least_good_mean = 80, largest_good_mean = 140;
constexpr double good_overexposed_share = 0.1;
constexpr double largest_change = 2;  // of the brightness, a step

// How many times brighter the frames should be.
double wantedChange(const FrameBrightness& brightness) {
  if (brightness.overexposed_share > good_overexposed_share && brightness.mean > least_good_mean) return 0.8;
  if (brightness.mean >= least_good_mean && brightness.mean <= largest_good_mean) return 1;
  return std::clamp(wanted_mean / std::max(brightness.mean, 1.0), 1 / largest_change, largest_change);
}

// At least one unit in the change's direction.
std::int64_t scaled(std::int64_t value, double change) {
  const auto moved = static_cast<std::int64_t>(std::llround(static_cast<double>(value) * change));
  return change > 1 ? std::max(moved, value + 1) : std::min(moved, value - 1);
}

}  // namespace

FrameBrightness frameBrightness(const cv::Mat& grey) {
  constexpr int step = 8;
  std::int64_t sum = 0, overexposed = 0, count = 0;
  for (int y = 0; y < grey.rows; y += step) {
    const std::uint8_t* const row = grey.ptr(y);
    for (int x = 0; x < grey.cols; x += step) {
      sum += row[x];
      overexposed += row[x] >= 250 ? 1 : 0;
      ++count;
    }
  }
  return {static_cast<double>(sum) / static_cast<double>(count),
          static_cast<double>(overexposed) / static_cast<double>(count)};
}

ExposureSetting nextExposure(const ExposureSetting& now, const ExposureRange& range,
                             const FrameBrightness& brightness) {
  const double change = wantedChange(brightness);
  if (change == 1) return now;
  ExposureSetting next = now;
  const std::int64_t gain_step = std::max<std::int64_t>((range.largest_gain - range.least_gain) / 16, 1);
  if (change > 1 && now.exposure < range.longest_exposure) {
    next.exposure = scaled(now.exposure, change);
  } else if (change > 1) {
    next.gain = now.gain + gain_step;
  } else if (now.gain > range.least_gain) {  // gain, which is noise, goes first
    next.gain = now.gain - gain_step;
  } else {
    next.exposure = scaled(now.exposure, change);
  }
  next.exposure = std::clamp(next.exposure, range.least_exposure, range.longest_exposure);
  next.gain = std::clamp(next.gain, range.least_gain, range.largest_gain);
  return next;
}

}  // namespace edgeslam
