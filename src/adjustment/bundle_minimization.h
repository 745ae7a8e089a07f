// Levenberg-Marquardt's method on a bundle problem.
#pragma once

#include <vector>

#include "adjustment/bundle_adjustment.h"
#include "adjustment/bundle_linearization.h"
#include "adjustment/reduced_solver.h"

namespace edgeslam {

// All that a minimisation needs beside the problem. To be used again: it keeps its memory.
struct BundleWorkspace {
  BundleStructure structure;
  BundleState state, candidate;
  BundleLinearization linearization;
  ReducedSolver solver;
  CameraStep step;
  std::vector<double> depth_changes;
  std::vector<Eigen::Vector4d> line_changes;
};

// Minimises the problem's robust cost; the end is `workspace.state`, of the cameras, points and lines of
// `workspace.structure`. The number of iterations, or -1 where nothing is free or observed, no step could be computed,
// or it was interrupted (`interrupted` may be null).
int minimizeBundle(const Camera& camera, const BundleProblem& problem, const BundleOptions& options,
                   const std::atomic<bool>* interrupted, BundleWorkspace& workspace);

}  // namespace edgeslam
