// What a bundle adjustment does with what an inertial unit says of its cameras: their turns, and how their mean speed
// changes; and with what wheels say: their turns, and the ways between them, m R_i^T (c_j - c_i), where a unit of
// the map is m metres of the wheels'.
//
// With P = s c + R t, the unit's place in metres for a camera at c turned by R, and from times and places of three
// cameras i, j, k the mean speeds V1 = (P_j - P_i) / T1 and V2 = (P_k - P_j) / T2, preintegration
// (inertia/preintegration.h) says
//   V2 - V1 = g (T1 + T2) / 2 + R_i of_first + R_j of_second,
// where of_first is the change of speed over T1 less the mean speed that it makes, and of_second the mean speed that
// what happens in T2 makes. The speed itself has dropped out, so that it is no unknown (Lupton and Sukkarieh, 2012,
// and Mur-Artal and Tardos, 2017, eliminate it likewise to find the scale).
//
// Where scale, gravity and biases are free, they are nine unknowns beside the cameras' (Campos, Montiel, Tardos, 2020,
// adjust them with the poses held): bends of the map that its measurements hardly oppose, and that look like another
// scale or bias, come out right only where all are adjusted together.
//
// Cameras' motions are twists [v; w] about the common origin o, as in bundle_linearization.h.
#pragma once

#include "adjustment/bundle_linearization.h"

namespace edgeslam {

// Inertia's and the wheels' part of the robust cost, of a problem as it stands and at a state.
double inertialCost(const BundleProblem& problem, double huber);
double inertialCost(const BundleProblem& problem, const BundleStructure& structure, const BundleState& state,
                    double huber);

// Adds both to normal equations whose blocks of pairs are not joined yet.
void linearizeInertia(const BundleProblem& problem, const BundleStructure& structure, const BundleState& state,
                      double huber, BundleLinearization& linearization);

// The same with what is adjusted of it moved.
BundleInertia movedInertia(const BundleInertia& inertia, const InertiaVector& change);

}  // namespace edgeslam
