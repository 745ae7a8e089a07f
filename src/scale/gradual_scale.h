// The metric scale as it is published: it moves gradually.
#pragma once

#include "geometry/scale_estimate.h"
#include "scale/scale_state.h"

namespace edgeslam {

// The scale as it is published. Unknown until an estimate's sigma is at most `largest_sigma`, then that estimate; from
// then on it follows the estimates by at most `largest_step` (share of the scale) a call, so that no controller meets
// a jump. Its sigma has in it how far it still is from the estimate.
class GradualScale {
 public:
  explicit GradualScale(double largest_sigma) : largest_sigma_(largest_sigma) {}

  // An estimate that is no scale to go by moves nothing; its sigma, where it is larger, is told.
  void follow(const ScaleEstimate& estimate, ScaleKind kind);
  void forget() { scale_ = {}; }

  const ScaleState& scale() const { return scale_; }
  static constexpr double largest_step = 0.001;

 private:
  double largest_sigma_;
  ScaleState scale_;
};

}  // namespace edgeslam
