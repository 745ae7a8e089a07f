// The reference of bundle adjustment: the same unknowns, residuals and loss, minimised by Ceres.
#pragma once

#include "adjustment/bundle_adjustment.h"

namespace edgeslam::test {

// Adjusts the problem in place; `scale_camera` is ignored. The number of iterations, or -1 where
// Ceres found no usable solution.
int adjustBundleByCeres(const Camera& camera, BundleProblem& problem, const BundleOptions& options);

}  // namespace edgeslam::test
