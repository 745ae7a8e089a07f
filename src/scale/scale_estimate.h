// The scale from many measurements of it, some of them wrong: the robust mean of their logarithms.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scale/scale_state.h"

namespace edgeslam {

struct ScaleMeasurement {
  double log_scale = 0;  // natural logarithm of metres a map unit
  double variance = 0;   // of it, over 0
};

struct ScaleEstimate {
  double log_scale = 0;
  double sigma = 0;     // standard deviation of it, that is of the scale over the scale
  std::string problem;  // why this is no scale to go by; sigma is then how far the measurements scatter. Or empty
};

// Errors that single measurements do not share average out, as far as their scatter bears their variances out;
// `shared_sigma` (standard deviation, share of the scale) does not. Of `independent` false nothing averages out: each
// measurement is made of much the same data. Measurements that the others contradict are left out; where these are
// over a third, it is no scale to go by. None where there are fewer than `fewest` (1 or more).
std::optional<ScaleEstimate> scaleEstimate(const std::vector<ScaleMeasurement>& measurements, std::size_t fewest,
                                           double shared_sigma, bool independent);

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
