// What some keyframes say of their camera's lens: with which focal length and distortion their adjustment costs least.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "geometry/found_camera.h"
#include "mapping/camera_trial.h"

namespace edgeslam {

// How the cost changes with the lens, about that of the camera that the rays are of: a parabola through trials. Changes
// are [logarithm of the focal lengths; by what share of its distance from the centre distortion moves a pixel half way
// to the farthest corner, and at nine tenths of it].
struct LensEquations {
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};
struct LensEstimate {
  Eigen::Vector3d change = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // if measurements err as they say
  double gain = 0;                                       // what the change takes off the cost
};

// Costs are no parabolas far from their least, so that what two changes do together may be told as more than both can
// do. It is brought down until each of the three has a share of its own.
Eigen::Matrix3d wellConditioned(const Eigen::Matrix3d& information);

// Nothing where the cost of some trial is not known, or has no least. Where none of the three by itself explains
// `least_gain` of the cost, they are taken to act each by itself: that takes a third of the trials.
// What lies farther off than `farthest_steps` between trials they do not tell: where the cost falls on, it is there.
std::optional<LensEquations> lensEquations(const LookedAt& at, double least_gain = 0,
                                           double farthest_steps = std::numeric_limits<double>::infinity());

// With the focal length, the distortion, or both free.
LensEstimate estimateLens(const LensEquations& equations, bool focal_length, bool distortion);

// With another lens than `camera`, in which `found` counts already. `most_focal_change`: of the logarithm of the focal
// lengths, over those of the calibration.
FoundCamera withLens(const Camera& camera, const FoundCamera& found, const Eigen::Vector3d& change,
                     double most_focal_change = 0.25);

// As much of a change as takes off the cost what the equations say; or nothing of it.
Eigen::Vector3d worthwhile(const LookedAt& at, const LensEquations& equations, Eigen::Vector3d change);

}  // namespace edgeslam
