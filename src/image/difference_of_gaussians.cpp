#include "image/difference_of_gaussians.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/difference_of_gaussians.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

// A blur sums columns, then rows. All sums are exact: a column's sum of 32 bits goes on as its upper 16 and its lower
// 16 bits less 0x8000, which are summed along the row each by itself and joined for the one rounding at the end.
// Products of 16-bit integers are summed in pairs of neighbouring ones, to the lanes of 32 bits.

HWY_BEFORE_NAMESPACE();
namespace edgeslam {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR

bool differenceOfVectors(const cv::Mat&, DifferenceOfGaussians&) { return false; }

#else

namespace hn = hwy::HWY_NAMESPACE;

using Narrow = hn::ScalableTag<int16_t>;
using Wide = hn::RepartitionToWide<Narrow>;
using Vector = hn::Vec<Narrow>;
using WideVector = hn::Vec<Wide>;

struct Sum {
  WideVector first;
  WideVector second;

  Sum() : first(hn::Zero(Wide())), second(hn::Zero(Wide())) {}
  void add(Vector values, Vector weights) {
    first = hn::ReorderWidenMulAccumulate(Wide(), values, weights, first, second);
  }
  WideVector total() const { return hn::RearrangeToOddPlusEven(first, second); }
};

// 16-bit lanes from the lower halves of 32-bit lanes: those of `even` and, one further, those of `odd`.
Vector lowerHalves(WideVector even, WideVector odd) {
  return hn::OddEven(hn::BitCast(Narrow(), hn::ShiftLeft<16>(odd)), hn::BitCast(Narrow(), even));
}

Vector upperHalves(WideVector even, WideVector odd) {
  return hn::OddEven(hn::BitCast(Narrow(), odd), hn::BitCast(Narrow(), hn::ShiftRight<16>(even)));
}

Vector weightsOf(int32_t pair) { return hn::BitCast(Narrow(), hn::Set(Wide(), pair)); }

// What a weight that is less by 1 << 16 leaves out: `values` of the even lanes, and of the odd ones, times that.
WideVector lackOfEven(Vector values) { return hn::ShiftLeft<16>(hn::BitCast(Wide(), values)); }
WideVector lackOfOdd(Vector values) {
  return hn::And(hn::BitCast(Wide(), values), hn::Set(Wide(), static_cast<int32_t>(0xFFFF0000)));
}

// Pixels as signed 16-bit integers, so small that the sum of two is one too.
Vector pixelsAt(const uint8_t* at) { return hn::PromoteTo(Narrow(), hn::LoadU(hn::Rebind<uint8_t, Narrow>(), at)); }
Vector pixelsAt(const uint16_t* at) {
  const auto values = hn::LoadU(hn::RebindToUnsigned<Narrow>(), at);
  return hn::Sub(hn::BitCast(Narrow(), values), hn::Set(Narrow(), 1 << 14));
}

// Sums a vector of columns that starts at x. `rows` are those of the kernel, the uppermost first.
template <typename Pixel>
void sumColumns(const std::vector<const uint8_t*>& rows, const FixedGaussian& gaussian, size_t x,
                int16_t* HWY_RESTRICT upper, int16_t* HWY_RESTRICT lower) {
  const auto radius = static_cast<size_t>(gaussian.radius());
  const auto pixels = [&](size_t row) HWY_ATTR { return pixelsAt(reinterpret_cast<const Pixel*>(rows[row]) + x); };
  Sum even;
  Sum odd;
  const auto add = [&](Vector a, Vector b, int32_t pair) HWY_ATTR {
    const Vector weights = weightsOf(pair);
    const auto wide_a = hn::BitCast(hn::RebindToUnsigned<Wide>(), a);
    even.add(hn::OddEven(hn::BitCast(Narrow(), hn::ShiftLeft<16>(hn::BitCast(Wide(), b))), a), weights);
    odd.add(hn::OddEven(b, hn::BitCast(Narrow(), hn::ShiftRight<16>(wide_a))), weights);
  };
  // Pixels as far above as below have one weight.
  const auto both = [&](size_t k) HWY_ATTR {
    return k > radius ? hn::Zero(Narrow()) : hn::Add(pixels(radius - k), pixels(radius + k));
  };
  const Vector centre = pixels(radius);
  add(centre, both(1), gaussian.pairs_from_centre[0]);
  for (size_t k = 2; k <= radius; k += 2) add(both(k), both(k + 1), gaussian.pairs_from_centre[k / 2]);
  WideVector even_sum = even.total();
  WideVector odd_sum = odd.total();
  if (gaussian.centre_is_less) {
    even_sum = hn::Add(even_sum, lackOfEven(centre));
    odd_sum = hn::Add(odd_sum, lackOfOdd(centre));
  }
  const auto sign = hn::Set(Narrow(), static_cast<int16_t>(-0x8000));
  hn::StoreU(upperHalves(even_sum, odd_sum), Narrow(), upper + x + radius);
  hn::StoreU(hn::Xor(lowerHalves(even_sum, odd_sum), sign), Narrow(), lower + x + radius);
}

// Sums of both parts along the row around a vector of pixels, for even and for odd lanes.
struct RowSums {
  WideVector even_upper;
  WideVector odd_upper;
  WideVector even_lower;
  WideVector odd_lower;
};

// `upper` and `lower` start `radius` pixels to the left of the first.
HWY_INLINE RowSums sumAlongRow(const int16_t* HWY_RESTRICT upper, const int16_t* HWY_RESTRICT lower,
                               const FixedGaussian& gaussian) {
  Sum even_upper, odd_upper, even_lower, odd_lower;
  const int32_t* pairs = gaussian.pairs_across.data();
  const int32_t* pairs_of_odd = gaussian.pairs_one_further.data();
  const size_t count = gaussian.pairs_across.size();
  for (size_t i = 0; i < count; ++i) {
    const Vector weights = weightsOf(pairs[i]);
    const Vector weights_of_odd = weightsOf(pairs_of_odd[i]);
    const Vector upper_values = hn::LoadU(Narrow(), upper + 2 * i);
    const Vector lower_values = hn::LoadU(Narrow(), lower + 2 * i);
    even_upper.add(upper_values, weights);
    odd_upper.add(upper_values, weights_of_odd);
    even_lower.add(lower_values, weights);
    odd_lower.add(lower_values, weights_of_odd);
  }
  RowSums sums = {even_upper.total(), odd_upper.total(), even_lower.total(), odd_lower.total()};
  if (gaussian.centre_is_less) {
    const Vector centre_upper = hn::LoadU(Narrow(), upper + gaussian.radius());
    const Vector centre_lower = hn::LoadU(Narrow(), lower + gaussian.radius());
    sums.even_upper = hn::Add(sums.even_upper, lackOfEven(centre_upper));
    sums.odd_upper = hn::Add(sums.odd_upper, lackOfOdd(centre_upper));
    sums.even_lower = hn::Add(sums.even_lower, lackOfEven(centre_lower));
    sums.odd_lower = hn::Add(sums.odd_lower, lackOfOdd(centre_lower));
  }
  return sums;
}

// What the parts are worth in the end. Of a kernel that sums to 1 << 16, a column's sum of S is upper * 2^16 + lower +
// 2^15, and along the row the sum is A * 2^16 + B + 2^31 for the sums A and B of the parts.
struct GreyBlur {  // of pixels times blur_scale, 2^7: rounded to 2^-25 of the sum
  static WideVector round(WideVector upper, WideVector lower) {
    const auto sum = hn::Add(hn::Add(upper, hn::ShiftRight<16>(lower)), hn::Set(Wide(), 1 << 8));
    return hn::Add(hn::ShiftRight<9>(sum), hn::Set(Wide(), 1 << 6));
  }
};
struct FurtherBlur {  // of pixels less 2^14: rounded to 2^-32 of the sum
  static WideVector round(WideVector upper, WideVector lower) {
    const auto sum = hn::Add(upper, hn::ShiftRight<16>(lower));
    return hn::Add(hn::ShiftRight<16>(sum), hn::Set(Wide(), (1 << 14) + 1));
  }
};

// Calls `work(x)` for vectors that cover 0 .. width - 1, the last one as far to the right as it goes.
template <typename Work>
void forVectors(size_t width, Work work) {
  const size_t lanes = hn::Lanes(Narrow());
  for (size_t x = 0; x + lanes < width; x += lanes) work(x);
  work(width - lanes);
}

// Gives row y of `image`, blurred, a vector of pixels after the other: take(x, vector).
template <typename Pixel, typename Blur, typename Take>
void blurRow(const cv::Mat& image, const FixedGaussian& gaussian, int y, DifferenceOfGaussians& memory, Take take) {
  const int radius = gaussian.radius();
  const auto width = static_cast<size_t>(image.cols);
  memory.rows.clear();
  for (int k = -radius; k <= radius; ++k) memory.rows.push_back(image.ptr(std::clamp(y + k, 0, image.rows - 1)));
  int16_t* upper = memory.upper.data();
  int16_t* lower = memory.lower.data();
  forVectors(width, [&](size_t x) HWY_ATTR { sumColumns<Pixel>(memory.rows, gaussian, x, upper, lower); });
  for (int16_t* parts : {upper, lower}) {
    std::fill_n(parts, radius, parts[radius]);
    int16_t* end = parts + static_cast<size_t>(radius) + width;
    std::fill_n(end, radius + 1, end[-1]);
  }
  forVectors(width, [&](size_t x) HWY_ATTR {
    const RowSums sums = sumAlongRow(upper + x, lower + x, gaussian);
    take(x, lowerHalves(Blur::round(sums.even_upper, sums.even_lower), Blur::round(sums.odd_upper, sums.odd_lower)));
  });
}

// False where the image is narrower than a vector.
bool differenceOfVectors(const cv::Mat& grey, DifferenceOfGaussians& result) {
  if (static_cast<size_t>(grey.cols) < hn::Lanes(Narrow())) return false;
  const int behind = result.to_wide.radius();  // rows by which the further blur follows
  for (int y = 0; y < grey.rows + behind; ++y) {
    if (y < grey.rows) {
      auto* narrow = result.narrow.ptr<int16_t>(y);
      blurRow<uint8_t, GreyBlur>(grey, result.to_narrow, y, result,
                                 [&](size_t x, Vector blurred) HWY_ATTR { hn::StoreU(blurred, Narrow(), narrow + x); });
    }
    if (y < behind) continue;
    const auto* narrow = result.narrow.ptr<int16_t>(y - behind);
    auto* dog = result.dog.ptr<int16_t>(y - behind);
    blurRow<uint16_t, FurtherBlur>(result.narrow, result.to_wide, y - behind, result,
                                   [&](size_t x, Vector blurred) HWY_ATTR {
                                     hn::StoreU(hn::Sub(hn::LoadU(Narrow(), narrow + x), blurred), Narrow(), dog + x);
                                   });
  }
  return true;
}

#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace edgeslam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgeslam {

HWY_EXPORT(differenceOfVectors);

void differenceOfGaussians(const cv::Mat& grey, double sigma, double sigma_ratio, DifferenceOfGaussians& result) {
  CV_Assert(grey.type() == CV_8U && !grey.empty());
  prepareDifferenceOfGaussians(grey.size(), sigma, sigma_ratio, result);
  if (!HWY_DYNAMIC_DISPATCH(differenceOfVectors)(grey, result)) {
    differenceOfGaussiansReference(grey, sigma, sigma_ratio, result);
  }
}

}  // namespace edgeslam
#endif
