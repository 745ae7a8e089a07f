// A window sampled from an image through an affine warp, in integers, so that it gives the same bits on every
// processor.
#pragma once

#include <cstddef>
#include <cstdint>

#include "flow/patch_kernels.h"

namespace edgeslam {

// Where the samples of a window lie: that of its centre, and from one sample to the next [px / 2^16].
struct WarpedGrid {
  std::int32_t x = 0, y = 0;
  std::int32_t x_by_column = 1 << 16, y_by_column = 0;
  std::int32_t x_by_row = 0, y_by_row = 1 << 16;
};

// Fills the (side + 2)^2 samples of a window, bilinear in shares of 1/256, from an image of 8 bits whose first pixel is
// at `origin` (`step` bytes a row, less than 2^31 bytes in all). All positions, and the pixels right and below of them,
// can be read. The window's other columns are left with no meaning.
void sampleWarpedWindow(const std::uint8_t* origin, std::ptrdiff_t step, const WarpedGrid& grid, int side,
                        SampledWindow& window);

// What sampleWarpedWindow gives, one sample after the other.
void sampleWarpedWindowReference(const std::uint8_t* origin, std::ptrdiff_t step, const WarpedGrid& grid, int side,
                                 SampledWindow& window);

}  // namespace edgeslam
