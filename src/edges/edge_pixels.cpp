#include "edges/edge_pixels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "edges/zero_crossing.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "edges/edge_pixels.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

#include "edges/edge_judgement-inl.h"

// Row after row: all pixels are tested for a zero crossing (markRow), integers are gathered around those that have one
// (gather), and from these, many at a time, follow position, normal and whether it is an edge (judge). Compiled without
// fused multiplications, so that floating point too has the reference's bits.

HWY_BEFORE_NAMESPACE();
namespace edgeslam {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR

bool findByVectors(const DifferenceOfGaussians&, const EdgeOptions&, EdgePixels&, cv::Mat&) { return false; }

#else

namespace hn = hwy::HWY_NAMESPACE;

using Pixels = hn::ScalableTag<int16_t>;
using Window = hn::CappedTag<int16_t, 8>;  // a row of the window to which a plane is fitted
using WindowSums = hn::RepartitionToWide<Window>;

constexpr int largest_window_radius = 3;  // that fits a row of the window

// Steepness is judged before all else in 16 bits: the upper halves of the squares of the components of twice the
// blurred image's gradient times square_scale, each cut off at largest_component.
constexpr int square_scale = 8;
constexpr int16_t largest_component = INT16_MAX / square_scale;

// No gradient that is steep enough has a smaller sum of them.
int16_t leastSquare(const EdgeOptions& options) {
  constexpr double lost = 2.01;  // by rounding down twice, and by what floating-point numbers may round up
  constexpr double largest_cut_off = 127 * 127;  // of a component that is cut off, or less
  const double steep = 2.0 * blur_scale * square_scale * std::max(0.0, options.gradient_threshold);
  return static_cast<int16_t>(std::clamp(steep * steep / (1 << 16) - lost, 0.0, largest_cut_off));
}

// Sets the bits of row y, the first one for the pixel `begin`, of those `count` pixels that may hold an edge: the DoG
// changes sign towards a 4-neighbour that is hardly nearer to zero, and the gradient is about steep enough.
void markRow(const DifferenceOfGaussians& images, int y, int begin, size_t count, int16_t least_square,
             uint8_t* HWY_RESTRICT bits) {
  const Pixels d;
  const auto* narrow = images.narrow.ptr<int16_t>(y) + begin;
  const auto* narrow_above = images.narrow.ptr<int16_t>(y - 1) + begin;
  const auto* narrow_below = images.narrow.ptr<int16_t>(y + 1) + begin;
  const auto* dog = images.dog.ptr<int16_t>(y) + begin;
  const auto* dog_above = images.dog.ptr<int16_t>(y - 1) + begin;
  const auto* dog_below = images.dog.ptr<int16_t>(y + 1) + begin;
  const auto zero = hn::Zero(d);
  const auto below_least_square = hn::Set(d, static_cast<int16_t>(least_square - 1));
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto along_x = hn::Abs(hn::Sub(hn::LoadU(d, narrow + i + 1), hn::LoadU(d, narrow + i - 1)));
    const auto along_y = hn::Abs(hn::Sub(hn::LoadU(d, narrow_below + i), hn::LoadU(d, narrow_above + i)));
    const auto here = hn::LoadU(d, dog + i);
    const auto left = hn::LoadU(d, dog + i - 1);
    const auto right = hn::LoadU(d, dog + i + 1);
    const auto above = hn::LoadU(d, dog_above + i);
    const auto below = hn::LoadU(d, dog_below + i);
    const auto lowest = hn::Min(hn::Min(left, right), hn::Min(above, below));
    const auto highest = hn::Max(hn::Max(left, right), hn::Max(above, below));
    const auto bar = hn::Sub(hn::ShiftRight<2>(here), here);
    const auto positive = hn::Gt(here, zero);
    const auto crosses =
        hn::Or(hn::AndNot(hn::Gt(lowest, bar), positive), hn::Not(hn::Or(positive, hn::Lt(highest, bar))));
    const auto squared = [&](hn::Vec<Pixels> component) HWY_ATTR {
      const auto scaled = hn::ShiftLeft<3>(hn::Min(component, hn::Set(d, largest_component)));
      return hn::MulHigh(scaled, scaled);
    };
    const auto steep = hn::Gt(hn::Add(squared(along_x), squared(along_y)), below_least_square);
    const auto marked = hn::And(crosses, steep);
    hn::StoreMaskBits(d, marked, bits + i / 8);
  }
}

// Lists the marked pixels; returns their number.
size_t listMarked(const uint8_t* bits, int begin, size_t count, int32_t* HWY_RESTRICT x) {
  size_t listed = 0;
  for (size_t first = 0; first < count; first += 64) {
    uint64_t word = 0;
    std::memcpy(&word, bits + first / 8, sizeof(word));
    if (count - first < 64) word &= (uint64_t{1} << (count - first)) - 1;
    for (; word != 0; word &= word - 1) {
      x[listed++] = begin + static_cast<int>(first + hwy::Num0BitsBelowLS1Bit_Nonzero64(word));
    }
  }
  return listed;
}

// The least-squares plane's slopes up to a factor, over the (2 radius + 1)^2 pixels around `centre` of the DoG, and how
// many of them are positive, each in summand_count parts.
template <int radius>
HWY_INLINE void fitPlane(const int16_t* centre, std::ptrdiff_t step, int32_t* HWY_RESTRICT slope_x,
                         int32_t* HWY_RESTRICT slope_y, int32_t* HWY_RESTRICT positive) {
  constexpr int16_t last_inside = 2 * radius;
  HWY_ALIGN constexpr int16_t lane_columns[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  const Window d;
  const WindowSums wide;
  const size_t lanes = hn::Lanes(d);
  const auto zero = hn::Zero(d);
  auto x0 = hn::Zero(wide), x1 = hn::Zero(wide), y0 = hn::Zero(wide), y1 = hn::Zero(wide), p0 = hn::Zero(wide),
       p1 = hn::Zero(wide);
  for (size_t i = 0; i < 8; i += lanes) {
    const auto columns = hn::Load(d, lane_columns + i);
    const auto is_inside = hn::Lt(columns, hn::Set(d, last_inside + 1));
    const auto weights = hn::IfThenElseZero(is_inside, hn::Sub(columns, hn::Set(d, radius)));
    const auto inside = hn::IfThenElseZero(is_inside, hn::Set(d, 1));
    const int16_t* at = centre - radius * step - radius + i;
    auto count = zero;
    auto row_weights = hn::IfThenElseZero(is_inside, hn::Set(d, -radius));
    for (int row = -radius; row <= radius; ++row, at += step) {
      const auto values = hn::LoadU(d, at);
      x0 = hn::ReorderWidenMulAccumulate(wide, values, weights, x0, x1);
      y0 = hn::ReorderWidenMulAccumulate(wide, values, row_weights, y0, y1);
      row_weights = hn::Add(row_weights, inside);
      count = hn::Sub(count, hn::VecFromMask(d, hn::Gt(values, zero)));  // a true mask is -1
    }
    p0 = hn::ReorderWidenMulAccumulate(wide, count, inside, p0, p1);
  }
  hn::StoreU(hn::Add(x0, x1), wide, slope_x);
  hn::StoreU(hn::Add(y0, y1), wide, slope_y);
  hn::StoreU(hn::Add(p0, p1), wide, positive);
}

// Fills in what lies around the first `count` candidates of row y.
template <int radius>
void gather(const DifferenceOfGaussians& images, int y, size_t count, EdgeCandidates& candidates) {
  const auto* narrow = images.narrow.ptr<int16_t>(y);
  const auto* dog = images.dog.ptr<int16_t>(y);
  const auto narrow_step = static_cast<std::ptrdiff_t>(images.narrow.step1());
  const auto dog_step = static_cast<std::ptrdiff_t>(images.dog.step1());
  for (size_t i = 0; i < count; ++i) {
    const int32_t x = candidates.x[i];
    const int32_t gradient_x = narrow[x + 1] - narrow[x - 1];
    const int32_t gradient_y = narrow[x + narrow_step] - narrow[x - narrow_step];
    const bool along_row = std::abs(gradient_x) >= std::abs(gradient_y);
    const std::ptrdiff_t across = along_row ? 1 : dog_step;
    const std::ptrdiff_t along = along_row ? dog_step : 1;
    const auto smoothed = [&](const int16_t* at) { return at[-along] + 2 * at[0] + at[along]; };
    candidates.gradient_x[i] = gradient_x;
    candidates.gradient_y[i] = gradient_y;
    candidates.before[i] = smoothed(dog + x - across);
    candidates.here[i] = smoothed(dog + x);
    candidates.after[i] = smoothed(dog + x + across);
    fitPlane<radius>(dog + x, dog_step, &candidates.slope_x[summand_count * i], &candidates.slope_y[summand_count * i],
                     &candidates.positive[summand_count * i]);
  }
}

// Adds those of the first `count` candidates of row y that are edges, and that there is room for.
void addEdges(size_t count, int y, const Thresholds& thresholds, size_t most, EdgePixels& pixels,
              int32_t* HWY_RESTRICT index) {
  HWY_ALIGN float pixel_x[most_lanes], pixel_y[most_lanes], normal_x[most_lanes], normal_y[most_lanes],
      gradient[most_lanes], offset[most_lanes];
  uint8_t bits[sizeof(uint64_t)] = {};
  const Floats d;
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    const Judged judged = judge(pixels.candidates, i, static_cast<float>(y), thresholds);
    hn::StoreMaskBits(d, judged.is_edge, bits);
    hn::Store(judged.pixel_x, d, pixel_x);
    hn::Store(judged.pixel_y, d, pixel_y);
    hn::Store(judged.normal_x, d, normal_x);
    hn::Store(judged.normal_y, d, normal_y);
    hn::Store(judged.gradient, d, gradient);
    hn::Store(judged.offset, d, offset);
    uint64_t word = 0;
    std::memcpy(&word, bits, sizeof(word));
    if (count - i < 64) word &= (uint64_t{1} << (count - i)) - 1;
    for (; word != 0 && pixels.points.size() < most; word &= word - 1) {
      const size_t k = hwy::Num0BitsBelowLS1Bit_Nonzero64(word);
      const int32_t x = pixels.candidates.x[i + k];
      index[x] = static_cast<int32_t>(pixels.points.size());
      pixels.points.push_back(
          {{pixel_x[k], pixel_y[k]}, {normal_x[k], normal_y[k]}, gradient[k], offset[k], cv::Point(x, y)});
    }
  }
}

void prepareCandidates(size_t width, EdgeCandidates& candidates) {
  constexpr size_t slack = HWY_MAX_BYTES;
  candidates.marks.resize(width / 8 + slack);
  for (auto* values : {&candidates.x, &candidates.gradient_x, &candidates.gradient_y, &candidates.before,
                       &candidates.here, &candidates.after}) {
    values->resize(width + slack);
  }
  for (auto* summands : {&candidates.slope_x, &candidates.slope_y, &candidates.positive}) {
    summands->resize(summand_count * (width + slack));
  }
}

// False where the image or the window is not of a size that vectors are made for.
bool findByVectors(const DifferenceOfGaussians& images, const EdgeOptions& options, EdgePixels& pixels,
                   cv::Mat& index) {
  const cv::Size size = images.dog.size();
  const int radius = options.plane_fit_radius;
  if (radius > largest_window_radius || static_cast<size_t>(size.width) < hn::Lanes(Pixels())) return false;
  prepareEdgePixels(size, pixels, index);
  prepareCandidates(static_cast<size_t>(size.width), pixels.candidates);
  const int margin = edgeMargin(options);
  if (size.width <= 2 * margin) return true;
  const auto count = static_cast<size_t>(size.width - 2 * margin);
  const auto threshold = static_cast<float>(options.gradient_threshold);
  const int window = (2 * radius + 1) * (2 * radius + 1);
  const Thresholds thresholds = {threshold * threshold,
                                 static_cast<int32_t>(std::floor(std::clamp(options.sign_balance, -1.0, 1.0) * window)),
                                 window};
  const int16_t least_square = leastSquare(options);
  const auto gather_row = radius == 1 ? gather<1> : radius == 2 ? gather<2> : gather<3>;
  for (int y = margin; y < size.height - margin; ++y) {
    markRow(images, y, margin, count, least_square, pixels.candidates.marks.data());
    const size_t listed = listMarked(pixels.candidates.marks.data(), margin, count, pixels.candidates.x.data());
    gather_row(images, y, listed, pixels.candidates);
    addEdges(listed, y, thresholds, mostEdgePoints(size), pixels, index.ptr<int32_t>(y));
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

HWY_EXPORT(findByVectors);

void findEdgePixels(const DifferenceOfGaussians& images, const EdgeOptions& options, EdgePixels& pixels,
                    cv::Mat& index) {
  if (!HWY_DYNAMIC_DISPATCH(findByVectors)(images, options, pixels, index)) {
    findEdgePixelsReference(images, options, pixels, index);
  }
}

}  // namespace edgeslam
#endif
