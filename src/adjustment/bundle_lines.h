// What a bundle adjustment does with straight lines: their share of the cost and of the normal equations, with each
// line's four unknowns eliminated as the inverse depths are, and how well they are known. An observation whose line is
// seen end-on counts as nothing: a cost would keep a line that is there from where it is.
//
// Cameras' motions are twists [v; w] about the common origin o, as in bundle_linearization.h. A camera whose centre is
// c moves by v + w x (c - o) and turns by w.
#pragma once

#include <vector>

#include "adjustment/bundle_linearization.h"

namespace edgeslam {

// The lines' part of the robust cost, at a state and of a problem as it stands.
double lineCost(const BundleStructure& structure, const BundleState& state, double huber);
double lineCost(const Camera& camera, const BundleProblem& problem, double huber);

// Adds the lines to normal equations that hold the points already; weights and damping as of linearizeBundle().
void linearizeLines(const BundleStructure& structure, const BundleState& state, double huber, double damping,
                    BundleLinearization& linearization);

// Change of each line, as of movedLine(), that goes with the twists (6 an unknown).
void changeLines(const BundleStructure& structure, const BundleLinearization& linearization,
                 const Eigen::VectorXd& twists, std::vector<Eigen::Vector4d>& changes);

// Errors and covariances of the lines of a problem as it stands.
void assessLines(const Camera& camera, const BundleProblem& problem, double huber, BundleResult& result);

}  // namespace edgeslam
