#include "edges/edge_neighbours.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "edges/edge_neighbours.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

// For a batch of points the pixels ahead and behind are looked up one after the other (lookUp); which of them is the
// best continuation is then found for many points at a time (choose). Of three pixels it could hardly be foretold which
// hold a point, so neither branches on it.

HWY_BEFORE_NAMESPACE();
namespace edgeslam {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR

void chooseByVectors(const std::vector<EdgePixel>& points, const cv::Mat& index, std::vector<int>& ahead,
                     std::vector<int>& behind) {
  chooseNeighboursReference(points, index, ahead, behind);
}

void keepMutualByVectors(std::vector<int>& ahead, std::vector<int>& behind) { keepMutualReference(ahead, behind); }

#else

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Integers = hn::RebindToSigned<Floats>;
using FloatVector = hn::Vec<Floats>;

constexpr size_t batch_size = 64;   // points
constexpr size_t turn_count = 3;    // straight on, to the right, to the left
constexpr size_t place_floats = 4;  // floats of a point: where it is and its normal, as in EdgePixel
constexpr size_t slack = 64;        // lanes of the longest vectors

struct Batch {
  HWY_ALIGN float own[place_floats * (batch_size + slack)];
  HWY_ALIGN int32_t octants[batch_size + slack];                               // in which each edge leads ahead
  HWY_ALIGN float others[2][turn_count][place_floats * (batch_size + slack)];  // ahead, behind
  HWY_ALIGN int32_t candidates[2][turn_count][batch_size + slack];
};

// As octant() does.
void findOctants(size_t count, Batch& batch) {
  const Floats d;
  const Integers di;
  const auto tan_of_eighth = hn::Set(d, tan_of_half_octant);
  for (size_t i = 0; i < count; i += hn::Lanes(d)) {
    FloatVector x, y, normal_x, normal_y;
    hn::LoadInterleaved4(d, &batch.own[place_floats * i], x, y, normal_x, normal_y);
    const auto along_x = hn::Neg(normal_y);
    const auto along_y = normal_x;
    const auto is_level = hn::Not(hn::Gt(hn::Abs(along_y), hn::Mul(tan_of_eighth, hn::Abs(along_x))));
    const auto is_upright = hn::Not(hn::Gt(hn::Abs(along_x), hn::Mul(tan_of_eighth, hn::Abs(along_y))));
    const auto right = hn::RebindMask(di, hn::Gt(along_x, hn::Zero(d)));
    const auto down = hn::RebindMask(di, hn::Gt(along_y, hn::Zero(d)));
    const auto level = hn::IfThenElse(right, hn::Zero(di), hn::Set(di, 4));
    const auto upright = hn::IfThenElse(down, hn::Set(di, 2), hn::Set(di, 6));
    const auto slanting = hn::IfThenElse(right, hn::IfThenElse(down, hn::Set(di, 1), hn::Set(di, 7)),
                                         hn::IfThenElse(down, hn::Set(di, 3), hn::Set(di, 5)));
    const auto upright_or_slanting = hn::IfThenElse(hn::RebindMask(di, is_upright), upright, slanting);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(di, is_level), level, upright_or_slanting), di, &batch.octants[i]);
  }
}

// To the neighbours around an entry of the index, around twice and more, so that a turn needs no bounds.
using Steps = std::array<std::ptrdiff_t, 19>;

void lookUp(const std::vector<EdgePixel>& points, const cv::Mat& index, const Steps& steps, size_t first, size_t count,
            Batch& batch) {
  static_assert(offsetof(EdgePixel, pixel) == 0 && offsetof(EdgePixel, normal) == 2 * sizeof(float));
  constexpr std::array<size_t, turn_count> turn_octants = {0, 1, 7};
  constexpr size_t place_bytes = place_floats * sizeof(float);
  for (size_t i = 0; i < count; ++i) std::memcpy(&batch.own[place_floats * i], &points[first + i], place_bytes);
  findOctants(count, batch);
  const auto* entries = index.ptr<int32_t>(0);
  const auto row_step = static_cast<std::ptrdiff_t>(index.step1());
  for (size_t i = 0; i < count; ++i) {
    const cv::Point& cell = points[first + i].cell;
    const int32_t* entry = entries + cell.y * row_step + cell.x;
    const std::ptrdiff_t* straight = &steps[static_cast<size_t>(batch.octants[i])];
    for (size_t side = 0; side < 2; ++side) {
      for (size_t turn = 0; turn < turn_count; ++turn) {
        const int32_t candidate = entry[straight[4 * side + turn_octants[turn]]];
        const int32_t readable = candidate & ~(candidate >> 31);  // the first point in place of -1
        batch.candidates[side][turn][i] = candidate;
        std::memcpy(&batch.others[side][turn][place_floats * i], &points[static_cast<size_t>(readable)], place_bytes);
      }
    }
  }
}

// Of a vector of points from i on: the best on one side, where `direction` leads.
hn::Vec<Integers> chooseSide(const Batch& batch, size_t side, size_t i, FloatVector pixel_x, FloatVector pixel_y,
                             FloatVector normal_x, FloatVector normal_y, FloatVector direction_x,
                             FloatVector direction_y) {
  const Floats d;
  const Integers di;
  auto best = hn::Set(di, -1);
  auto least_cost = hn::Set(d, std::numeric_limits<float>::max());
  for (size_t turn = 0; turn < turn_count; ++turn) {
    FloatVector other_x, other_y, other_normal_x, other_normal_y;
    hn::LoadInterleaved4(d, &batch.others[side][turn][place_floats * i], other_x, other_y, other_normal_x,
                         other_normal_y);
    const auto dot = [](FloatVector ax, FloatVector ay, FloatVector bx, FloatVector by)
                         HWY_ATTR { return hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)); };
    const auto difference_x = hn::Sub(other_x, pixel_x);
    const auto difference_y = hn::Sub(other_y, pixel_y);
    const auto agreement = dot(normal_x, normal_y, other_normal_x, other_normal_y);
    const auto way = dot(difference_x, difference_y, direction_x, direction_y);
    const auto off_here = dot(difference_x, difference_y, normal_x, normal_y);
    const auto off_there = dot(difference_x, difference_y, other_normal_x, other_normal_y);
    const auto off = hn::Add(hn::Mul(off_here, off_here), hn::Mul(off_there, off_there));
    const auto cost =
        hn::Add(dot(difference_x, difference_y, difference_x, difference_y), hn::Mul(hn::Set(d, 4.0F), off));
    const auto candidate = hn::LoadU(di, &batch.candidates[side][turn][i]);
    const auto is_there = hn::RebindMask(d, hn::Gt(candidate, hn::Set(di, -1)));
    const auto agrees = hn::And(is_there, hn::Ge(agreement, hn::Set(d, least_neighbour_agreement)));
    const auto allowed = hn::And(agrees, hn::Gt(way, hn::Zero(d)));
    const auto better = hn::And(allowed, hn::Lt(cost, least_cost));
    least_cost = hn::IfThenElse(better, cost, least_cost);
    best = hn::IfThenElse(hn::RebindMask(di, better), candidate, best);
  }
  return best;
}

void chooseByVectors(const std::vector<EdgePixel>& points, const cv::Mat& index, std::vector<int>& ahead,
                     std::vector<int>& behind) {
  const Floats d;
  const Integers di;
  Batch batch;
  HWY_ALIGN int32_t best_ahead[batch_size + slack];
  HWY_ALIGN int32_t best_behind[batch_size + slack];
  std::memset(&batch, 0, sizeof(batch));
  Steps steps;
  for (size_t i = 0; i < steps.size(); ++i) steps[i] = stepTo(static_cast<int>(i % 8), index);
  const auto* entries = index.ptr<int32_t>(0);
  const auto row_step = static_cast<std::ptrdiff_t>(index.step1());
  for (size_t first = 0; first < points.size(); first += batch_size) {
    const size_t count = std::min(batch_size, points.size() - first);
    lookUp(points, index, steps, first, count, batch);
    for (size_t i = 0; i < count; i += hn::Lanes(d)) {
      FloatVector x, y, normal_x, normal_y;
      hn::LoadInterleaved4(d, &batch.own[place_floats * i], x, y, normal_x, normal_y);
      const auto opposite_x = hn::Neg(normal_x);
      const auto opposite_y = hn::Neg(normal_y);
      // Along `ahead` the edge runs a quarter turn from its normal.
      hn::StoreU(chooseSide(batch, 0, i, x, y, normal_x, normal_y, opposite_y, normal_x), di, best_ahead + i);
      hn::StoreU(chooseSide(batch, 1, i, x, y, normal_x, normal_y, normal_y, opposite_x), di, best_behind + i);
    }
    for (size_t i = 0; i < count; ++i) {
      const cv::Point& cell = points[first + i].cell;
      const bool is_named = entries[cell.y * row_step + cell.x] == static_cast<int32_t>(first + i);
      ahead[first + i] = is_named ? best_ahead[i] : not_named;
      behind[first + i] = is_named ? best_behind[i] : not_named;
    }
  }
}

// Forgets those choices that are not answered. Their number is at least that of a vector's lanes.
void forgetUnanswered(const std::vector<int>& answers, std::vector<int>& choices) {
  const Integers d;
  const auto none = hn::Set(d, -1);
  const size_t last = choices.size() - hn::Lanes(d);
  for (size_t next = 0; next < choices.size(); next += hn::Lanes(d)) {
    const size_t i = std::min(next, last);
    const auto choice = hn::LoadU(d, &choices[i]);
    const auto is_choice = hn::Gt(choice, none);
    const auto answer = hn::GatherIndex(d, answers.data(), hn::IfThenElseZero(is_choice, choice));
    const auto is_answered = hn::Eq(answer, hn::Iota(d, static_cast<int32_t>(i)));
    hn::StoreU(hn::IfThenElse(hn::AndNot(is_answered, is_choice), none, choice), d, &choices[i]);
  }
}

void keepMutualByVectors(std::vector<int>& ahead, std::vector<int>& behind) {
  if (ahead.size() < hn::Lanes(Integers())) return keepMutualReference(ahead, behind);
  forgetUnanswered(behind, ahead);
  forgetUnanswered(ahead, behind);
}

#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace edgeslam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgeslam {

HWY_EXPORT(chooseByVectors);
HWY_EXPORT(keepMutualByVectors);

void chooseNeighbours(const std::vector<EdgePixel>& points, const cv::Mat& index, std::vector<int>& ahead,
                      std::vector<int>& behind) {
  assert(index.type() == CV_32S && index.isContinuous());
  HWY_DYNAMIC_DISPATCH(chooseByVectors)(points, index, ahead, behind);
}

void keepMutual(std::vector<int>& ahead, std::vector<int>& behind) {
  assert(ahead.size() == behind.size());
  HWY_DYNAMIC_DISPATCH(keepMutualByVectors)(ahead, behind);
}

}  // namespace edgeslam
#endif
