#include <cmath>

#include "flow/patch_kernels.h"

namespace edgeslam {
namespace {

std::int16_t sampleAt(const std::uint8_t* at, std::ptrdiff_t step, const BilinearWeights& weights) {
  constexpr int rounding = 128 / samples_per_grey, shift = 5;  // of 256 / samples_per_grey
  const int sum =
      weights.here * at[0] + weights.right * at[1] + weights.below * at[step] + weights.below_right * at[step + 1];
  return static_cast<std::int16_t>((sum + rounding) >> shift);
}

// Takes the rounded mean off, and returns it.
std::int32_t takeMeanOff(PatchRows& rows, int side) {
  std::int32_t sum = 0;
  for (const std::int16_t value : rows) sum += value;
  const auto mean = static_cast<std::int32_t>(std::lround(static_cast<double>(sum) / (side * side)));
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      std::int16_t& value = rows[static_cast<std::size_t>(y * patch_row + x)];
      value = static_cast<std::int16_t>(value - mean);
    }
  }
  return mean;
}

std::int32_t product(const PatchRows& a, const PatchRows& b) {
  std::int32_t sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

std::int32_t sumOf(const PatchRows& rows) {
  std::int32_t sum = 0;
  for (const std::int16_t value : rows) sum += value;
  return sum;
}

}  // namespace

BilinearWeights bilinearWeights(float right_share, float below_share) {
  BilinearWeights weights;
  weights.below_right = static_cast<std::uint16_t>(right_share * below_share * 256 + 0.5f);
  weights.right = static_cast<std::uint16_t>(static_cast<int>(right_share * 256 + 0.5f) - weights.below_right);
  weights.below = static_cast<std::uint16_t>(static_cast<int>(below_share * 256 + 0.5f) - weights.below_right);
  weights.here = static_cast<std::uint16_t>(256 - weights.right - weights.below - weights.below_right);
  return weights;
}

void sampleWindowReference(const std::uint8_t* corner, std::ptrdiff_t step, const BilinearWeights& weights, int side,
                           SampledWindow& window) {
  for (int y = 0; y < side + 2; ++y, corner += step) {
    for (int x = 0; x < window_row; ++x) {
      window[static_cast<std::size_t>(y * window_row + x)] = sampleAt(corner + x, step, weights);
    }
  }
}

PatchSums makePatchSamplesReference(const SampledWindow& window, int side, PatchSamples& patch) {
  patch.side = side;
  patch.grey.fill(0);
  patch.gradient_x.fill(0);
  patch.gradient_y.fill(0);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const std::int16_t* centre = window.data() + (y + 1) * window_row + x + 1;
      const auto at = static_cast<std::size_t>(y * patch_row + x);
      patch.grey[at] = *centre;
      patch.gradient_x[at] = static_cast<std::int16_t>(centre[1] - centre[-1]);
      patch.gradient_y[at] = static_cast<std::int16_t>(centre[window_row] - centre[-window_row]);
    }
  }
  patch.grey_mean = takeMeanOff(patch.grey, side);
  patch.x_mean = takeMeanOff(patch.gradient_x, side);
  patch.y_mean = takeMeanOff(patch.gradient_y, side);
  PatchSums sums;
  sums.grey = sumOf(patch.grey);
  sums.x = sumOf(patch.gradient_x);
  sums.y = sumOf(patch.gradient_y);
  sums.grey_grey = product(patch.grey, patch.grey);
  sums.grey_x = product(patch.grey, patch.gradient_x);
  sums.grey_y = product(patch.grey, patch.gradient_y);
  sums.xx = product(patch.gradient_x, patch.gradient_x);
  sums.xy = product(patch.gradient_x, patch.gradient_y);
  sums.yy = product(patch.gradient_y, patch.gradient_y);
  return sums;
}

ComparisonSums comparePatchReference(const PatchSamples& patch, const std::uint8_t* corner, std::ptrdiff_t step,
                                     const BilinearWeights& weights) {
  ComparisonSums sums;
  for (int y = 0; y < patch.side; ++y, corner += step) {
    for (int x = 0; x < patch.side; ++x) {
      const int sample = sampleAt(corner + x, step, weights);
      const auto at = static_cast<std::size_t>(y * patch_row + x);
      sums.samples += sample;
      sums.squares += sample * sample;
      sums.with_grey += sample * patch.grey[at];
      sums.with_x += sample * patch.gradient_x[at];
      sums.with_y += sample * patch.gradient_y[at];
    }
  }
  return sums;
}

CorrelationSums correlatePatchReference(const PatchSamples& patch, const std::uint8_t* corner, std::ptrdiff_t step,
                                        const BilinearWeights& weights) {
  const ComparisonSums sums = comparePatchReference(patch, corner, step, weights);
  return {sums.samples, sums.squares, sums.with_grey};
}

}  // namespace edgeslam
