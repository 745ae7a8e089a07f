#include "flow/warped_window.h"

namespace edgeslam {

void sampleWarpedWindowReference(const std::uint8_t* origin, std::ptrdiff_t step, const WarpedGrid& grid, int side,
                                 SampledWindow& window) {
  const int outer = side + 2, radius = outer / 2;
  for (int row = 0; row < outer; ++row) {
    std::int32_t x = grid.x + (row - radius) * grid.x_by_row - radius * grid.x_by_column;
    std::int32_t y = grid.y + (row - radius) * grid.y_by_row - radius * grid.y_by_column;
    std::int16_t* samples = window.data() + row * window_row;
    for (int column = 0; column < outer; ++column, x += grid.x_by_column, y += grid.y_by_column) {
      const std::uint8_t* at = origin + (y >> 16) * step + (x >> 16);
      const int right = (x >> 8) & 255, below = (y >> 8) & 255;
      const int upper = (256 - right) * at[0] + right * at[1];
      const int lower = (256 - right) * at[step] + right * at[step + 1];
      samples[column] = static_cast<std::int16_t>(((256 - below) * upper + below * lower + (1 << 12)) >> 13);
    }
  }
}

}  // namespace edgeslam
