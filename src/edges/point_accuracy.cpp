#include "edges/point_accuracy.h"

#include <algorithm>

#include "edges/image_noise.h"

namespace edgeslam {

PointAccuracy accuracyIn(const cv::Mat& grey, const PointAccuracyOptions& options, const CameraMask* mask) {
  return {options, std::max(0.0, gradientNoise(grey, mask) - options.noise)};
}

double sigmaAcross(bool corner, const PointAccuracy& accuracy) {
  return accuracy.noise_factor * (corner ? accuracy.options.sigma_corner : accuracy.options.sigma_edge);
}

bool isCornerLike(const Eigenvalues& values, const PointAccuracy& accuracy) {
  const auto noise = static_cast<float>(accuracy.excess_noise);
  const float l1 = values.l1 - noise, l2 = values.l2 - noise;
  return l2 > static_cast<float>(accuracy.options.corner_ratio) * l1 &&
         l2 > static_cast<float>(accuracy.options.corner_strength);
}

float informativeL2(float l2, const PointAccuracy& accuracy) {
  return std::max(l2 - static_cast<float>(accuracy.options.noise + accuracy.excess_noise), 1e-6F);
}

}  // namespace edgeslam
