// What a vector of pixels is worth that may hold an edge: position, normal, and whether it is an edge. Included by
// edge_pixels.cpp once for each instruction set.
#if defined(EDGESLAM_EDGE_JUDGEMENT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGESLAM_EDGE_JUDGEMENT_INL_H
#undef EDGESLAM_EDGE_JUDGEMENT_INL_H
#else
#define EDGESLAM_EDGE_JUDGEMENT_INL_H
#endif

#include <hwy/highway.h>

#include <cmath>

#include "edges/edge_pixels.h"
#include "edges/zero_crossing.h"

HWY_BEFORE_NAMESPACE();
namespace edgeslam {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET != HWY_SCALAR

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Integers = hn::RebindToSigned<Floats>;
using FloatVector = hn::Vec<Floats>;
using IntegerVector = hn::Vec<Integers>;

constexpr size_t most_lanes = HWY_MAX_BYTES / sizeof(float);
constexpr size_t summand_count = 4;

#if HWY_ARCH_ARM_V7

// 32-bit NEON has neither quotients nor roots to the last bit; the scalar unit beside it has.
template <class Operation>
HWY_INLINE FloatVector laneByLane(FloatVector a, FloatVector b, const Operation& operation) {
  const Floats d;
  HWY_ALIGN float first[most_lanes], second[most_lanes];
  hn::Store(a, d, first);
  hn::Store(b, d, second);
  for (size_t i = 0; i < hn::Lanes(d); ++i) first[i] = operation(first[i], second[i]);
  return hn::Load(d, first);
}

HWY_INLINE FloatVector quotient(FloatVector a, FloatVector b) {
  return laneByLane(a, b, [](float above, float below) { return above / below; });
}

HWY_INLINE FloatVector root(FloatVector a) {
  return laneByLane(a, a, [](float value, float) { return std::sqrt(value); });
}

#else

HWY_INLINE FloatVector quotient(FloatVector a, FloatVector b) { return hn::Div(a, b); }

HWY_INLINE FloatVector root(FloatVector a) { return hn::Sqrt(a); }

#endif

IntegerVector sumOfSummands(const std::vector<int32_t>& summands, size_t i) {
  IntegerVector a, b, c, d;
  hn::LoadInterleaved4(Integers(), &summands[summand_count * i], a, b, c, d);
  return hn::Add(hn::Add(a, b), hn::Add(c, d));
}

struct Thresholds {
  float squared_gradient;
  int32_t imbalance;  // most |2 positive - all|
  int32_t window;     // pixels
};

// What a vector of candidates is worth, and which of them are edges.
struct Judged {
  HWY_ATTR Judged() {}  // one that the compiler makes is not of the instruction set, and NEON vectors have constructors

  FloatVector pixel_x;
  FloatVector pixel_y;
  FloatVector normal_x;
  FloatVector normal_y;
  FloatVector gradient;
  FloatVector offset;
  hn::Mask<Floats> is_edge;
};

Judged judge(const EdgeCandidates& candidates, size_t i, float y, const Thresholds& thresholds) {
  const Floats d;
  const Integers di;
  const auto load = [&](const std::vector<int32_t>& values) HWY_ATTR { return hn::LoadU(di, &values[i]); };
  const auto zero = hn::Zero(di);
  Judged judged;

  const IntegerVector gradient_x = load(candidates.gradient_x);
  const IntegerVector gradient_y = load(candidates.gradient_y);
  const FloatVector scale = hn::Set(d, 0.5F / blur_scale);
  const FloatVector x_component = hn::Mul(scale, hn::ConvertTo(d, gradient_x));
  const FloatVector y_component = hn::Mul(scale, hn::ConvertTo(d, gradient_y));
  const FloatVector squared = hn::Add(hn::Mul(x_component, x_component), hn::Mul(y_component, y_component));
  judged.gradient = root(squared);
  judged.normal_x = quotient(x_component, judged.gradient);
  judged.normal_y = quotient(y_component, judged.gradient);

  // As offsetOfZero does: between this pixel and the one after it, or before it, whichever is not nearer to zero.
  const IntegerVector here = load(candidates.here);
  const IntegerVector before = load(candidates.before);
  const IntegerVector after = load(candidates.after);
  const auto sign_differs = [&](IntegerVector other) HWY_ATTR {
    return hn::Xor(hn::VecFromMask(di, hn::Gt(here, zero)), hn::VecFromMask(di, hn::Gt(other, zero)));
  };
  const auto crosses_after = hn::AndNot(hn::Gt(hn::Abs(here), hn::Abs(after)), hn::MaskFromVec(sign_differs(after)));
  const auto crosses_before = hn::And(hn::MaskFromVec(sign_differs(before)), hn::Lt(hn::Abs(here), hn::Abs(before)));
  const IntegerVector fall = hn::IfThenElse(crosses_after, hn::Sub(here, after), hn::Sub(before, here));
  judged.offset = quotient(hn::ConvertTo(d, here), hn::ConvertTo(d, fall));

  // As isEdgeLike does.
  const FloatVector slope_x = hn::ConvertTo(d, sumOfSummands(candidates.slope_x, i));
  const FloatVector slope_y = hn::ConvertTo(d, sumOfSummands(candidates.slope_y, i));
  const IntegerVector positive = sumOfSummands(candidates.positive, i);
  const IntegerVector imbalance = hn::Abs(hn::Sub(hn::Add(positive, positive), hn::Set(di, thresholds.window)));
  const FloatVector rise = hn::Add(hn::Mul(slope_x, judged.normal_x), hn::Mul(slope_y, judged.normal_y));
  const FloatVector squared_slope = hn::Add(hn::Mul(slope_x, slope_x), hn::Mul(slope_y, slope_y));
  const FloatVector least_squared_rise =
      hn::Mul(hn::Set(d, least_slope_agreement * least_slope_agreement), squared_slope);
  const auto rises = hn::And(hn::Gt(rise, hn::Zero(d)), hn::Ge(hn::Mul(rise, rise), least_squared_rise));

  const auto along_row = hn::RebindMask(d, hn::Not(hn::Lt(hn::Abs(gradient_x), hn::Abs(gradient_y))));
  const FloatVector way = hn::Mul(judged.offset, hn::IfThenElse(along_row, judged.normal_x, judged.normal_y));
  judged.pixel_x = hn::Add(hn::ConvertTo(d, load(candidates.x)), hn::Mul(way, judged.normal_x));
  judged.pixel_y = hn::Add(hn::Set(d, y), hn::Mul(way, judged.normal_y));

  const auto crosses = hn::Or(crosses_after, crosses_before);
  const auto balanced = hn::Lt(imbalance, hn::Set(di, thresholds.imbalance + 1));
  const auto steep = hn::Ge(squared, hn::Set(d, thresholds.squared_gradient));
  judged.is_edge = hn::And(hn::And(steep, rises), hn::RebindMask(d, hn::And(crosses, balanced)));
  return judged;
}

#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace edgeslam
HWY_AFTER_NAMESPACE();

#endif
