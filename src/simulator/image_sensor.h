// The simulator's image sensor: vignetting, gain, shot and read noise, 8 bits; and a slow automatic exposure.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace edgeslam {

struct SensorOptions {
  double noise = 2.0;        // standard deviation at grey 128 [grey]: half its variance is read noise, half shot noise
  double vignetting = 0.25;  // light lost in the image's corners
};

// Grey image (CV_8U) of `radiance` (CV_32F): grey = 255 * gain * radiance * vignetting + noise. Same seed, same noise.
cv::Mat senseImage(const cv::Mat& radiance, double gain, const SensorOptions& options, std::uint64_t seed);

// Standard deviation of the noise at a grey value [grey], before rounding to whole grey values.
double noiseAt(double grey, const SensorOptions& options);

// Gain of each frame of a camera that follows the mean radiance of its frames, `interval_s` apart, with a lag.
std::vector<double> automaticGains(const std::vector<double>& mean_radiances, double interval_s);

}  // namespace edgeslam
