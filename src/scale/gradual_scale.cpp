#include "scale/gradual_scale.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {

void GradualScale::follow(const ScaleEstimate& estimate, ScaleKind kind) {
  if (scale_.kind == ScaleKind::unknown) {
    const double metres_per_unit = std::exp(estimate.log_scale);
    if (!estimate.problem.empty() || !(estimate.sigma <= largest_sigma_) || !std::isnormal(metres_per_unit)) return;
    scale_ = {kind, metres_per_unit, estimate.sigma};
    return;
  }
  const double way = estimate.log_scale - std::log(scale_.metres_per_unit);
  if (!estimate.problem.empty()) {
    scale_.sigma = std::max(scale_.sigma, std::hypot(estimate.sigma, way));
    return;
  }
  const double step = std::clamp(way, -largest_step, largest_step);
  scale_.metres_per_unit *= std::exp(step);
  scale_.sigma = std::hypot(estimate.sigma, way - step);
}

}  // namespace edgeslam
