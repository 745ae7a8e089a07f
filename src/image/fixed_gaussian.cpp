#include "image/fixed_gaussian.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {
namespace {

constexpr double kLeastSigma = 0.05;  // narrower than this a Gaussian is a single pixel [px]

}  // namespace

FixedGaussian fixedGaussian(double sigma) {
  constexpr int32_t kOne = 1 << kWeightBits;
  if (sigma < kLeastSigma) return {{kOne}};
  const int radius = std::max(1, static_cast<int>(std::lround(2.9 * sigma)));
  std::vector<double> heights;
  double sum = 1;
  for (int k = radius; k > 0; --k) {
    heights.push_back(std::exp(-0.5 * k * k / (sigma * sigma)));
    sum += 2 * heights.back();
  }
  FixedGaussian gaussian;
  gaussian.weights.assign(static_cast<size_t>(radius) + 1, kOne);
  double left_over = 0;
  for (int k = radius; k > 0; --k) {
    const double wanted = heights[static_cast<size_t>(radius - k)] / sum * kOne + left_over;
    const auto weight = static_cast<int32_t>(std::lround(wanted));
    left_over = wanted - weight;
    gaussian.weights[static_cast<size_t>(k)] = weight;
    gaussian.weights[0] -= 2 * weight;
  }
  return gaussian;
}

}  // namespace edgeslam
