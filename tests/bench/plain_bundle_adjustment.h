// The plain formulation of bundle adjustment, to be compared with: Ceres, three coordinates a point, six a camera,
// every view of a point a residual, its host's too. Analytic Jacobians, the rotation matrices computed once an
// evaluation, points eliminated first.
#pragma once

#include "adjustment/bundle_adjustment.h"

namespace edgeslam {

// Adjusts poses and depths in place. In the host's view a point was seen at its bearing, with the sigmas and normal of
// its first observation; fixed points and priors are ignored. The number of iterations, or -1 where there is no
// solution.
int adjustBundlePlainly(const Camera& camera, BundleProblem& problem, const BundleOptions& options, bool sparse);

}  // namespace edgeslam
