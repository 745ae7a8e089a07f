#include "flow/patch_kernels.h"

#include <cassert>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "flow/patch_kernels.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace edgeslam {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR

void sampleWindowVectors(const std::uint8_t* corner, std::ptrdiff_t step, const BilinearWeights& weights, int side,
                         SampledWindow& window) {
  sampleWindowReference(corner, step, weights, side, window);
}

PatchSums makePatchVectors(const SampledWindow& window, int side, PatchSamples& patch) {
  return makePatchSamplesReference(window, side, patch);
}

ComparisonSums compareVectors(const PatchSamples& patch, const std::uint8_t* corner, std::ptrdiff_t step,
                              const BilinearWeights& weights) {
  return comparePatchReference(patch, corner, step, weights);
}

CorrelationSums correlateVectors(const PatchSamples& patch, const std::uint8_t* corner, std::ptrdiff_t step,
                                 const BilinearWeights& weights) {
  return correlatePatchReference(patch, corner, step, weights);
}

#else

namespace hn = hwy::HWY_NAMESPACE;

template <int most>
using Samples = hn::CappedTag<std::int16_t, most>;
using Sixteen = Samples<16>;
using Eight = Samples<8>;
using Sums = hn::RepartitionToWide<Sixteen>;

// Blends pixels of two rows into samples.
template <class Tag>
class Blend {
 public:
  using Wide = hn::RebindToUnsigned<Tag>;
  using Vector = hn::Vec<Wide>;

  explicit Blend(const BilinearWeights& weights)
      : here_(hn::Set(Wide(), weights.here)),
        right_(hn::Set(Wide(), weights.right)),
        below_(hn::Set(Wide(), weights.below)),
        below_right_(hn::Set(Wide(), weights.below_right)) {}

  static Vector pixels(const std::uint8_t* at) {
    return hn::PromoteTo(Wide(), hn::LoadU(hn::Rebind<std::uint8_t, Tag>(), at));
  }

  // Of the largest sum, 256 x 255 + 16, nothing is lost in 16 bits.
  hn::Vec<Tag> operator()(Vector here, Vector right, Vector below, Vector below_right) const {
    const Vector upper = hn::Add(hn::Mul(here, here_), hn::Mul(right, right_));
    const Vector lower = hn::Add(hn::Mul(below, below_), hn::Mul(below_right, below_right_));
    const Vector sum = hn::Add(hn::Add(upper, lower), hn::Set(Wide(), 128 / samples_per_grey));
    return hn::BitCast(Tag(), hn::ShiftRight<5>(sum));
  }

 private:
  Vector here_, right_, below_, below_right_;
};

class ProductSum {
 public:
  ProductSum() : first_(hn::Zero(Sums())), second_(hn::Zero(Sums())) {}
  void add(hn::Vec<Sixteen> a, hn::Vec<Sixteen> b) {
    first_ = hn::ReorderWidenMulAccumulate(Sums(), a, b, first_, second_);
  }
  std::int32_t total() const { return hn::GetLane(hn::SumOfLanes(Sums(), hn::Add(first_, second_))); }

 private:
  hn::Vec<Sums> first_, second_;
};

template <class Tag>
void sampleColumns(const std::uint8_t* corner, std::ptrdiff_t step, const Blend<Tag>& blend, int rows,
                   std::int16_t* samples) {
  auto here = blend.pixels(corner), right = blend.pixels(corner + 1);
  for (int y = 0; y < rows; ++y, samples += window_row) {
    corner += step;
    const auto below = blend.pixels(corner), below_right = blend.pixels(corner + 1);
    hn::StoreU(blend(here, right, below, below_right), Tag(), samples);
    here = below;
    right = below_right;
  }
}

void sampleWindowVectors(const std::uint8_t* corner, std::ptrdiff_t step, const BilinearWeights& weights, int side,
                         SampledWindow& window) {
  const int lanes = static_cast<int>(hn::Lanes(Sixteen()));
  for (int x = 0; x < patch_row; x += lanes) {
    sampleColumns(corner + x, step, Blend<Sixteen>(weights), side + 2, window.data() + x);
  }
  const int rest = static_cast<int>(hn::Lanes(Eight()));
  for (int x = patch_row; x < window_row; x += rest) {
    sampleColumns(corner + x, step, Blend<Eight>(weights), side + 2, window.data() + x);
  }
}

// What is to be taken off each value, and the sum of what is left.
struct Mean {
  std::int32_t mean;
  std::int32_t left;

  Mean(std::int32_t sum, int count)
      : mean(static_cast<std::int32_t>(std::lround(static_cast<double>(sum) / count))), left(sum - mean * count) {}
};

PatchSums makePatchVectors(const SampledWindow& window, int side, PatchSamples& patch) {
  patch.side = side;
  const Sixteen tag;
  const int lanes = static_cast<int>(hn::Lanes(tag));
  const auto ones = hn::Set(tag, 1);
  ProductSum grey_sum, x_sum, y_sum;
  for (int x = 0; x < patch_row; x += lanes) {
    const auto inside = hn::VecFromMask(tag, hn::FirstN(tag, static_cast<std::size_t>(side > x ? side - x : 0)));
    for (int y = 0; y < side; ++y) {
      const std::int16_t* centre = window.data() + (y + 1) * window_row + x + 1;
      const auto grey = hn::And(hn::LoadU(tag, centre), inside);
      const auto along_x = hn::And(hn::Sub(hn::LoadU(tag, centre + 1), hn::LoadU(tag, centre - 1)), inside);
      const auto along_y =
          hn::And(hn::Sub(hn::LoadU(tag, centre + window_row), hn::LoadU(tag, centre - window_row)), inside);
      const int at = y * patch_row + x;
      hn::Store(grey, tag, patch.grey.data() + at);
      hn::Store(along_x, tag, patch.gradient_x.data() + at);
      hn::Store(along_y, tag, patch.gradient_y.data() + at);
      grey_sum.add(grey, ones);
      x_sum.add(along_x, ones);
      y_sum.add(along_y, ones);
    }
  }
  const int count = side * side;
  const Mean grey_mean(grey_sum.total(), count), x_mean(x_sum.total(), count), y_mean(y_sum.total(), count);
  patch.grey_mean = grey_mean.mean;
  patch.x_mean = x_mean.mean;
  patch.y_mean = y_mean.mean;
  ProductSum grey_grey, grey_x, grey_y, xx, xy, yy;
  for (int x = 0; x < patch_row; x += lanes) {
    const auto inside = hn::VecFromMask(tag, hn::FirstN(tag, static_cast<std::size_t>(side > x ? side - x : 0)));
    const auto grey_off = hn::And(hn::Set(tag, static_cast<std::int16_t>(grey_mean.mean)), inside);
    const auto x_off = hn::And(hn::Set(tag, static_cast<std::int16_t>(x_mean.mean)), inside);
    const auto y_off = hn::And(hn::Set(tag, static_cast<std::int16_t>(y_mean.mean)), inside);
    for (int y = 0; y < side; ++y) {
      const int at = y * patch_row + x;
      const auto grey = hn::Sub(hn::Load(tag, patch.grey.data() + at), grey_off);
      const auto along_x = hn::Sub(hn::Load(tag, patch.gradient_x.data() + at), x_off);
      const auto along_y = hn::Sub(hn::Load(tag, patch.gradient_y.data() + at), y_off);
      hn::Store(grey, tag, patch.grey.data() + at);
      hn::Store(along_x, tag, patch.gradient_x.data() + at);
      hn::Store(along_y, tag, patch.gradient_y.data() + at);
      grey_grey.add(grey, grey);
      grey_x.add(grey, along_x);
      grey_y.add(grey, along_y);
      xx.add(along_x, along_x);
      xy.add(along_x, along_y);
      yy.add(along_y, along_y);
    }
  }
  for (int y = side; y < largest_patch_side; ++y) {
    for (PatchRows* rows : {&patch.grey, &patch.gradient_x, &patch.gradient_y}) {
      for (int x = 0; x < patch_row; x += lanes) hn::Store(hn::Zero(tag), tag, rows->data() + y * patch_row + x);
    }
  }
  return {grey_mean.left, x_mean.left, y_mean.left, grey_grey.total(), grey_x.total(),
          grey_y.total(), xx.total(),  xy.total(),  yy.total()};
}

// Gives each row of a window's samples, 0 beyond the patch, and its place in the patch to `add`.
template <class Add>
void forEachRow(const PatchSamples& patch, const std::uint8_t* corner, std::ptrdiff_t step,
                const BilinearWeights& weights, const Add& add) {
  const Sixteen tag;
  const int lanes = static_cast<int>(hn::Lanes(tag));
  const Blend<Sixteen> blend(weights);
  for (int x = 0; x < patch_row; x += lanes) {
    const auto inside =
        hn::VecFromMask(tag, hn::FirstN(tag, static_cast<std::size_t>(patch.side > x ? patch.side - x : 0)));
    const std::uint8_t* row = corner + x;
    auto here = blend.pixels(row), right = blend.pixels(row + 1);
    for (int y = 0; y < patch.side; ++y) {
      row += step;
      const auto below = blend.pixels(row), below_right = blend.pixels(row + 1);
      add(hn::And(blend(here, right, below, below_right), inside), y * patch_row + x);
      here = below;
      right = below_right;
    }
  }
}

ComparisonSums compareVectors(const PatchSamples& patch, const std::uint8_t* corner, std::ptrdiff_t step,
                              const BilinearWeights& weights) {
  const Sixteen tag;
  const auto ones = hn::Set(tag, 1);
  ProductSum samples, squares, with_grey, with_x, with_y;
  forEachRow(patch, corner, step, weights, [&](hn::Vec<Sixteen> sample, int at) HWY_ATTR {
    samples.add(sample, ones);
    squares.add(sample, sample);
    with_grey.add(sample, hn::Load(tag, patch.grey.data() + at));
    with_x.add(sample, hn::Load(tag, patch.gradient_x.data() + at));
    with_y.add(sample, hn::Load(tag, patch.gradient_y.data() + at));
  });
  return {samples.total(), squares.total(), with_grey.total(), with_x.total(), with_y.total()};
}

CorrelationSums correlateVectors(const PatchSamples& patch, const std::uint8_t* corner, std::ptrdiff_t step,
                                 const BilinearWeights& weights) {
  const Sixteen tag;
  const auto ones = hn::Set(tag, 1);
  ProductSum samples, squares, with_grey;
  forEachRow(patch, corner, step, weights, [&](hn::Vec<Sixteen> sample, int at) HWY_ATTR {
    samples.add(sample, ones);
    squares.add(sample, sample);
    with_grey.add(sample, hn::Load(tag, patch.grey.data() + at));
  });
  return {samples.total(), squares.total(), with_grey.total()};
}

#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace edgeslam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgeslam {

HWY_EXPORT(sampleWindowVectors);
HWY_EXPORT(makePatchVectors);
HWY_EXPORT(compareVectors);
HWY_EXPORT(correlateVectors);

void sampleWindow(const std::uint8_t* corner, std::ptrdiff_t step, const BilinearWeights& weights, int side,
                  SampledWindow& window) {
  assert(side >= 1 && side <= largest_patch_side);
  HWY_DYNAMIC_DISPATCH(sampleWindowVectors)(corner, step, weights, side, window);
}

PatchSums makePatchSamples(const SampledWindow& window, int side, PatchSamples& patch) {
  assert(side >= 1 && side <= largest_patch_side);
  return HWY_DYNAMIC_DISPATCH(makePatchVectors)(window, side, patch);
}

ComparisonSums comparePatch(const PatchSamples& patch, const std::uint8_t* corner, std::ptrdiff_t step,
                            const BilinearWeights& weights) {
  return HWY_DYNAMIC_DISPATCH(compareVectors)(patch, corner, step, weights);
}

CorrelationSums correlatePatch(const PatchSamples& patch, const std::uint8_t* corner, std::ptrdiff_t step,
                               const BilinearWeights& weights) {
  return HWY_DYNAMIC_DISPATCH(correlateVectors)(patch, corner, step, weights);
}

}  // namespace edgeslam
#endif
