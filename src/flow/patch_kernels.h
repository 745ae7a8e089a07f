// The arithmetic of patch alignment on 16-bit samples: bilinear windows, their differences, and the sums of products
// that the steps need. All in integers, so that it gives the same bits on every processor.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace edgeslam {

constexpr int largest_patch_side = 15;  // [px]
constexpr int patch_row = 16;           // samples from one row of a patch to the next; those beyond its side are 0
constexpr int window_row = 24;          // samples from one row of a sampled window to the next
constexpr int samples_per_grey = 8;     // a sample is a grey value times this

// Shares of the four pixels around a position, in 1/256; they sum up to 256.
struct BilinearWeights {
  std::uint16_t here = 256, right = 0, below = 0, below_right = 0;
};

// `right_share` and `below_share` in [0, 1].
BilinearWeights bilinearWeights(float right_share, float below_share);

// Samples around a patch, one more on each side: (side + 2)^2 of them.
using SampledWindow = std::array<std::int16_t, (largest_patch_side + 2) * window_row>;
using PatchRows = std::array<std::int16_t, largest_patch_side * patch_row>;

// A patch's samples and twice their gradient [per px], each less its rounded mean.
struct PatchSamples {
  alignas(32) PatchRows grey;
  alignas(32) PatchRows gradient_x;
  alignas(32) PatchRows gradient_y;
  int side = 0;
  std::int32_t grey_mean = 0, x_mean = 0, y_mean = 0;  // what was taken off
};

// Sums over a patch: of its samples and gradients after their means were taken off, and of their products.
struct PatchSums {
  std::int32_t grey = 0, x = 0, y = 0;
  std::int32_t grey_grey = 0, grey_x = 0, grey_y = 0, xx = 0, xy = 0, yy = 0;
};

// Sums over a window of another image: of its samples, their squares, and their products with a patch.
struct ComparisonSums {
  std::int32_t samples = 0, squares = 0, with_grey = 0, with_x = 0, with_y = 0;

  bool operator==(const ComparisonSums& other) const {
    return samples == other.samples && squares == other.squares && with_grey == other.with_grey &&
           with_x == other.with_x && with_y == other.with_y;
  }
};

// The same without the gradient.
struct CorrelationSums {
  std::int32_t samples = 0, squares = 0, with_grey = 0;

  bool operator==(const CorrelationSums& other) const {
    return samples == other.samples && squares == other.squares && with_grey == other.with_grey;
  }
};

// Fills a window from the pixels of 8 bits at `corner` (upper left, `step` bytes a row). Reads up to 9 pixels to the
// right of the window.
void sampleWindow(const std::uint8_t* corner, std::ptrdiff_t step, const BilinearWeights& weights, int side,
                  SampledWindow& window);

// The patch in the middle of a window.
PatchSums makePatchSamples(const SampledWindow& window, int side, PatchSamples& patch);

// Compares a patch with the side x side samples at `corner`. Reads up to 2 pixels to the right of the window.
ComparisonSums comparePatch(const PatchSamples& patch, const std::uint8_t* corner, std::ptrdiff_t step,
                            const BilinearWeights& weights);

// Of comparePatch's sums those that a correlation needs.
CorrelationSums correlatePatch(const PatchSamples& patch, const std::uint8_t* corner, std::ptrdiff_t step,
                               const BilinearWeights& weights);

// What sampleWindow, makePatchSamples, comparePatch and correlatePatch give, one sample after the other.
void sampleWindowReference(const std::uint8_t* corner, std::ptrdiff_t step, const BilinearWeights& weights, int side,
                           SampledWindow& window);
PatchSums makePatchSamplesReference(const SampledWindow& window, int side, PatchSamples& patch);
ComparisonSums comparePatchReference(const PatchSamples& patch, const std::uint8_t* corner, std::ptrdiff_t step,
                                     const BilinearWeights& weights);
CorrelationSums correlatePatchReference(const PatchSamples& patch, const std::uint8_t* corner, std::ptrdiff_t step,
                                        const BilinearWeights& weights);

}  // namespace edgeslam
