#include "simulator/image_sensor.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace edgeslam {
namespace {

constexpr double target_mean = 0.49;  // of full scale
constexpr double exposure_lag_s = 0.8;
constexpr double darkest_mean = 0.25;  // of the first frame's: the gain does not follow the light below this

// Standard normal numbers to a good approximation: the sum of four 16-bit uniform numbers, scaled. Integers up to the
// last step, so the same on every machine.
class SensorNoise {
 public:
  explicit SensorNoise(std::uint64_t seed) : generator_(seed) {}
  float next() {
    const std::uint64_t bits = generator_();
    const std::uint64_t sum = (bits & 0xFFFFU) + ((bits >> 16U) & 0xFFFFU) + ((bits >> 32U) & 0xFFFFU) + (bits >> 48U);
    // Mean 4 * 65535 / 2; variance 4 * (65536^2 - 1) / 12.
    return (static_cast<float>(sum) - 131070.0F) * (1.0F / 37837.227F);
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace

double noiseAt(double grey, const SensorOptions& options) {
  return options.noise * std::sqrt(0.5 + 0.5 * std::max(0.0, grey) / 128);
}

cv::Mat senseImage(const cv::Mat& radiance, double gain, const SensorOptions& options, std::uint64_t seed) {
  SensorNoise noise(seed);
  cv::Mat grey(radiance.size(), CV_8U);
  const float centre_x = 0.5F * static_cast<float>(radiance.cols - 1),
              centre_y = 0.5F * static_cast<float>(radiance.rows - 1);
  const float corner = centre_x * centre_x + centre_y * centre_y;
  const float scale = static_cast<float>(255 * gain),
              loss = static_cast<float>(options.vignetting) / std::max(1.0F, corner);
  const float variance = static_cast<float>(0.5 * options.noise * options.noise);
  for (int y = 0; y < radiance.rows; ++y) {
    const float* in = radiance.ptr<float>(y);
    unsigned char* out = grey.ptr<unsigned char>(y);
    const float dy = static_cast<float>(y) - centre_y;
    for (int x = 0; x < radiance.cols; ++x) {
      const float dx = static_cast<float>(x) - centre_x;
      float value = scale * in[x] * (1 - loss * (dx * dx + dy * dy));
      if (variance > 0) value += std::sqrt(variance * (1 + std::max(0.0F, value) / 128.0F)) * noise.next();
      out[x] = static_cast<unsigned char>(std::clamp(value, 0.0F, 255.0F) + 0.5F);
    }
  }
  return grey;
}

std::vector<double> automaticGains(const std::vector<double>& mean_radiances, double interval_s) {
  std::vector<double> gains;
  if (mean_radiances.empty()) return gains;
  const double share = 1 - std::exp(-interval_s / exposure_lag_s);
  const double first = std::max(1e-6, mean_radiances.front());
  double followed = first;
  for (const double mean : mean_radiances) {
    followed += share * (std::max(mean, darkest_mean * first) - followed);
    gains.push_back(target_mean / followed);
  }
  return gains;
}

}  // namespace edgeslam
