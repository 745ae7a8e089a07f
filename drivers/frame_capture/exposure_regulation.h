// Exposure against blur: where the driver's own automatic knows no limit, exposure time and gain are set from the
// frames' brightness, the time never above its limit and gain only where the time is used up.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace edgeslam {

// Whole numbers of the driver's units. Brightness is taken as proportional to exposure, and to the gain's offset from
// where it would be black, which drivers do not tell: a step of gain is therefore small, and felt in the next frames.
struct ExposureRange {
  std::int64_t least_exposure = 1, longest_exposure = 1;
  std::int64_t least_gain = 0, largest_gain = 0;  // the same where there is no gain
};

struct ExposureSetting {
  std::int64_t exposure = 1;
  std::int64_t gain = 0;
};

inline bool operator==(const ExposureSetting& a, const ExposureSetting& b) {
  return a.exposure == b.exposure && a.gain == b.gain;
}

// What a frame's pixels say, from every 8th of every 8th row.
struct FrameBrightness {
  double mean = 0;               // [grey]
  double overexposed_share = 0;  // of pixels at 250 or above
};

// `grey`: CV_8U, not empty.
FrameBrightness frameBrightness(const cv::Mat& grey);

// The setting for the next frames; the same one where the brightness is good (mean 80 to 140, few pixels
// overexposed), so that it comes to rest.
ExposureSetting nextExposure(const ExposureSetting& now, const ExposureRange& range, const FrameBrightness& brightness);

}  // namespace edgeslam
