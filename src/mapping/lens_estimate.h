// What some keyframes say of their camera's lens: with which focal length, distortion and principal point their
// adjustment costs least, and which of the three they tell apart from those of the calibration.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>

#include "geometry/found_camera.h"
#include "mapping/camera_trial.h"

namespace edgeslam {

// A lens beside another one: [logarithm of the focal lengths; by what share of its distance from the centre distortion
// moves a pixel half way to the farthest corner, and at nine tenths of it; principal point [px]].
using LensVector = Eigen::Matrix<double, 5, 1>;
using LensMatrix = Eigen::Matrix<double, 5, 5>;

struct LensParts {
  bool focal_length = false, distortion = false, principal_point = false;
};
inline bool any(const LensParts& parts) { return parts.focal_length || parts.distortion || parts.principal_point; }

// How the cost changes with the lens, about that of the camera that the rays are of: a parabola through trials.
struct LensEquations {
  LensVector gradient = LensVector::Zero();
  LensMatrix information = LensMatrix::Zero();
};

// What is known of the lens before.
struct LensKnowledge {
  LensVector sigma = LensVector::Ones();  // standard deviation of the calibration
  LensVector found = LensVector::Zero();  // the lens that the rays are of, beside the calibration's
};

struct LensEstimate {
  LensVector change = LensVector::Zero();
  LensVector sigma = LensVector::Zero();  // standard deviation
  double gain = 0;                        // what the change takes off the cost
  double evidence = 0;  // how much likelier the change is than none: the logarithm of the ratio of likelihoods
};

// Costs are no parabolas far from their least, so that what several changes do together may be told as more than they
// can do. It is brought down until each of them has a share of its own.
LensMatrix wellConditioned(const LensMatrix& information);

// Nothing where the cost of some trial is not known, or has no least. Where none of the five by itself explains
// `least_gain` of the cost, they are taken to act each by itself: that takes a third of the trials.
// What lies farther off than `farthest_steps` between trials they do not tell: where the cost falls on, it is there.
std::optional<LensEquations> lensEquations(const LookedAt& at, double least_gain = 0,
                                           double farthest_steps = std::numeric_limits<double>::infinity());

// What the keyframes and the calibration say together, with these parts free.
LensEstimate estimateLens(const LensEquations& equations, const LensKnowledge& known, const LensParts& free);

// Those of the parts that are `looked_for` that are told to be other than they are calibrated, and those that are
// `found` already. What adds too little to the evidence of the others is as it was, the least telling one first.
LensParts toldOfLens(const LensEquations& equations, const LensKnowledge& known, const LensParts& looked_for,
                     const LensParts& found);

// How well a calibration, and a lens that is presumed, is known.
LensVector sigmaOfCalibration(const Camera& camera);
LensVector sigmaOfPresumed(const Camera& camera);

// The lens that was found, beside that of the calibration.
LensVector lensOf(const Camera& camera, const FoundCamera& found);

// With another lens than `camera`, in which `found` counts already. `most_focal_change`: of the logarithm of the focal
// lengths, over those of the calibration.
FoundCamera withLens(const Camera& camera, const FoundCamera& found, const LensVector& change,
                     double most_focal_change = 0.25);

// As much of a change as takes off the cost what the equations say; or nothing of it.
LensVector worthwhile(const LookedAt& at, const LensEquations& equations, LensVector change);

}  // namespace edgeslam
