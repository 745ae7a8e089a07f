#include "image/halving.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/halving.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace edgeslam {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR

void halveVectors(const cv::Mat& finer, cv::Mat& coarser) { halveReference(finer, coarser); }

#else

namespace hn = hwy::HWY_NAMESPACE;

// Pixels of a coarser row at a time: what they need stays in the nearest cache [px].
constexpr size_t block_width = 512;

// Sums of 5 rows (1 4 6 4 1) at `centre` for `count` pairs of neighbouring pixels: of the first of each, and of the
// second. May write and read up to a vector more.
void sumColumns(const uint8_t* centre, std::ptrdiff_t step, size_t count, uint16_t* HWY_RESTRICT first,
                uint16_t* HWY_RESTRICT second) {
  const hn::ScalableTag<uint16_t> d;
  const hn::Repartition<uint8_t, decltype(d)> bytes;
  const auto low_byte = hn::Set(d, 0xFF);
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const uint8_t* at = centre + 2 * i;
    // As a 16-bit integer a pair has its first pixel in the lower byte.
    const auto pair = [&](std::ptrdiff_t row) HWY_ATTR { return hn::BitCast(d, hn::LoadU(bytes, at + row * step)); };
    const auto p0 = pair(-2), p1 = pair(-1), p2 = pair(0), p3 = pair(1), p4 = pair(2);
    const auto weigh = [&](auto v0, auto v1, auto v2, auto v3, auto v4) HWY_ATTR {
      const auto twice_middle = hn::Add(v2, v2);
      const auto inner = hn::Add(hn::Add(v1, v3), v2);
      return hn::Add(hn::Add(hn::Add(v0, v4), twice_middle), hn::ShiftLeft<2>(inner));
    };
    const auto lower = [&](auto v) HWY_ATTR { return hn::And(v, low_byte); };
    const auto upper = [&](auto v) HWY_ATTR { return hn::ShiftRight<8>(v); };
    hn::StoreU(weigh(lower(p0), lower(p1), lower(p2), lower(p3), lower(p4)), d, first + i);
    hn::StoreU(weigh(upper(p0), upper(p1), upper(p2), upper(p3), upper(p4)), d, second + i);
  }
}

// Of one row: `even[i + 1]` is the sum of column 2 i, `odd[i + 1]` that of column 2 i + 1.
void sumRow(const uint16_t* HWY_RESTRICT even, const uint16_t* HWY_RESTRICT odd, size_t count,
            uint8_t* HWY_RESTRICT row) {
  const hn::ScalableTag<uint16_t> d;
  const hn::RebindToSigned<decltype(d)> signed_d;
  const hn::Rebind<uint8_t, decltype(d)> bytes;
  const auto half = hn::Set(d, 128);
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto outer = hn::Add(hn::LoadU(d, even + i), hn::LoadU(d, even + i + 2));
    const auto inner = hn::Add(hn::LoadU(d, odd + i), hn::LoadU(d, odd + i + 1));
    const auto middle = hn::LoadU(d, even + i + 1);
    const auto sum =
        hn::Add(hn::Add(hn::Add(outer, hn::Add(middle, middle)), half), hn::ShiftLeft<2>(hn::Add(inner, middle)));
    hn::StoreU(hn::DemoteTo(bytes, hn::BitCast(signed_d, hn::ShiftRight<8>(sum))), bytes, row + i);
  }
}

void halveVectors(const cv::Mat& finer, cv::Mat& coarser) {
  constexpr size_t slack = 2 + HWY_MAX_BYTES / sizeof(uint16_t);
  HWY_ALIGN uint16_t even[block_width + 2 * slack];
  HWY_ALIGN uint16_t odd[block_width + 2 * slack];
  HWY_ALIGN uint8_t row[block_width + slack];
  const auto step = static_cast<std::ptrdiff_t>(finer.step[0]);
  const auto width = static_cast<size_t>(coarser.cols);
  for (int y = 0; y < coarser.rows; ++y) {
    for (size_t x = 0; x < width; x += block_width) {
      const size_t count = std::min(block_width, width - x);
      sumColumns(finer.ptr<uint8_t>(2 * y) + 2 * x - 2, step, count + 2, even, odd);
      sumRow(even, odd, count, row);
      std::memcpy(coarser.ptr<uint8_t>(y) + x, row, count);
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

HWY_EXPORT(halveVectors);

void halve(const cv::Mat& finer, cv::Mat& coarser) {
  CV_Assert(finer.type() == CV_8U && coarser.type() == CV_8U && coarser.size() == halfOf(finer.size()));
  HWY_DYNAMIC_DISPATCH(halveVectors)(finer, coarser);
}

}  // namespace edgeslam
#endif
