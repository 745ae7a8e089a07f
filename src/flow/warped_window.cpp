#include "flow/warped_window.h"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "flow/warped_window.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

// Row after row: where the samples lie is computed for many at a time, their pixels are fetched one after the other,
// and blended for many at a time.

HWY_BEFORE_NAMESPACE();
namespace edgeslam {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR

void sampleWarped(const std::uint8_t* origin, std::ptrdiff_t step, const WarpedGrid& grid, int side,
                  SampledWindow& window) {
  sampleWarpedWindowReference(origin, step, grid, side, window);
}

#else

namespace hn = hwy::HWY_NAMESPACE;

using Integers = hn::CappedTag<std::int32_t, 8>;  // of which a window's row is a multiple
using Vector = hn::Vec<Integers>;

// Of the samples of one row.
struct RowOfSamples {
  HWY_ALIGN std::int32_t x_of_column[window_row];  // from the first [px / 2^16]
  HWY_ALIGN std::int32_t y_of_column[window_row];
  HWY_ALIGN std::int32_t offsets[window_row];  // of the pixel from the image's first one [bytes]
  HWY_ALIGN std::int32_t upper[window_row];    // the pixel, and the one to its right times 2^8
  HWY_ALIGN std::int32_t lower[window_row];    // the same below
};

// On little-endian processors, which are all that the instruction sets here run on.
std::int32_t pairAt(const std::uint8_t* at) {
  std::uint16_t pair = 0;
  std::memcpy(&pair, at, sizeof(pair));
  return pair;
}

void fetchPixels(const std::uint8_t* origin, std::ptrdiff_t step, int count, RowOfSamples& row) {
  for (int i = 0; i < count; ++i) {
    const std::uint8_t* at = origin + row.offsets[i];
    row.upper[i] = pairAt(at);
    row.lower[i] = pairAt(at + step);
  }
}

void sampleWarped(const std::uint8_t* origin, std::ptrdiff_t step, const WarpedGrid& grid, int side,
                  SampledWindow& window) {
  const Integers d;
  const hn::Rebind<std::int16_t, Integers> narrow;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int outer = side + 2, radius = outer / 2;
  const auto step_of_rows = hn::Set(d, static_cast<std::int32_t>(step));
  const auto low_byte = hn::Set(d, 255);
  const auto share = [&](Vector position) HWY_ATTR { return hn::And(hn::ShiftRight<8>(position), low_byte); };
  RowOfSamples row;
  for (int column = 0; column < window_row; ++column) {
    row.x_of_column[column] = column * grid.x_by_column;
    row.y_of_column[column] = column * grid.y_by_column;
    row.upper[column] = row.lower[column] = 0;
  }
  for (int y = 0; y < outer; ++y) {
    const auto first_x = hn::Set(d, grid.x + (y - radius) * grid.x_by_row - radius * grid.x_by_column);
    const auto first_y = hn::Set(d, grid.y + (y - radius) * grid.y_by_row - radius * grid.y_by_column);
    for (int i = 0; i < outer; i += lanes) {
      const auto sample_x = hn::Add(first_x, hn::Load(d, row.x_of_column + i));
      const auto sample_y = hn::Add(first_y, hn::Load(d, row.y_of_column + i));
      const auto offset = hn::Add(hn::Mul(hn::ShiftRight<16>(sample_y), step_of_rows), hn::ShiftRight<16>(sample_x));
      hn::Store(offset, d, row.offsets + i);
    }
    fetchPixels(origin, step, outer, row);
    for (int i = 0; i < outer; i += lanes) {
      const auto right = share(hn::Add(first_x, hn::Load(d, row.x_of_column + i)));
      const auto below = share(hn::Add(first_y, hn::Load(d, row.y_of_column + i)));
      // 256 a + share (b - a) = (256 - share) a + share b
      const auto between = [&](const std::int32_t* pairs) HWY_ATTR {
        const auto pair = hn::Load(d, pairs + i);
        const auto left_pixel = hn::And(pair, low_byte);
        const auto right_pixel = hn::ShiftRight<8>(pair);
        return hn::Add(hn::ShiftLeft<8>(left_pixel), hn::Mul(right, hn::Sub(right_pixel, left_pixel)));
      };
      const auto upper = between(row.upper);
      const auto lower = between(row.lower);
      const auto sum = hn::Add(hn::ShiftLeft<8>(upper), hn::Mul(below, hn::Sub(lower, upper)));
      const auto sample = hn::ShiftRight<13>(hn::Add(sum, hn::Set(d, 1 << 12)));
      hn::StoreU(hn::DemoteTo(narrow, sample), narrow, window.data() + y * window_row + i);
    }
  }
}

#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace edgeslam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgeslam {

HWY_EXPORT(sampleWarped);

void sampleWarpedWindow(const std::uint8_t* origin, std::ptrdiff_t step, const WarpedGrid& grid, int side,
                        SampledWindow& window) {
  HWY_DYNAMIC_DISPATCH(sampleWarped)(origin, step, grid, side, window);
}

}  // namespace edgeslam
#endif
