#include "image/fixed_gaussian.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace edgeslam {
namespace {

constexpr double least_sigma = 0.05;  // narrower than this a Gaussian is a single pixel [px]

int32_t pairOf(int32_t first, int32_t second) {
  const auto low = static_cast<uint32_t>(first) & 0xFFFF;
  return static_cast<int32_t>(low | static_cast<uint32_t>(second) << 16);
}

FixedGaussian withPairs(std::vector<int32_t> weights) {
  FixedGaussian gaussian;
  gaussian.weights = std::move(weights);
  const int radius = gaussian.radius();
  const auto weight = [&](int k) {
    return std::abs(k) > radius ? 0 : gaussian.weights[static_cast<size_t>(std::abs(k))];
  };
  for (int k = 0; k <= radius; k += 2) gaussian.pairs_from_centre.push_back(pairOf(weight(k), weight(k + 1)));
  for (int k = -radius; k <= radius; k += 2) {
    gaussian.pairs_across.push_back(pairOf(weight(k), weight(k + 1)));
    gaussian.pairs_one_further.push_back(pairOf(weight(k - 1), weight(k)));
  }
  gaussian.centre_is_less = weight(0) >= 1 << 15;
  return gaussian;
}

}  // namespace

FixedGaussian fixedGaussian(double sigma) {
  assert(sigma >= 0);
  constexpr int32_t one = 1 << weight_bits;
  if (sigma < least_sigma) return withPairs({one});
  const int radius = std::max(1, static_cast<int>(std::lround(2.9 * sigma)));
  std::vector<double> heights;
  double sum = 1;
  for (int k = radius; k > 0; --k) {
    heights.push_back(std::exp(-0.5 * k * k / (sigma * sigma)));
    sum += 2 * heights.back();
  }
  std::vector<int32_t> weights(static_cast<size_t>(radius) + 1, one);
  double left_over = 0;
  for (int k = radius; k > 0; --k) {
    const double wanted = heights[static_cast<size_t>(radius - k)] / sum * one + left_over;
    const auto weight = static_cast<int32_t>(std::lround(wanted));
    left_over = wanted - weight;
    weights[static_cast<size_t>(k)] = weight;
    weights[0] -= 2 * weight;
  }
  return withPairs(std::move(weights));
}

}  // namespace edgeslam
