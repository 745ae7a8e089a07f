// What some keyframes say of where their camera's optical axis meets the image: with which principal point their
// adjustment costs least.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "mapping/camera_trial.h"

namespace edgeslam {

struct PrincipalPointEstimate {
  Eigen::Vector2d change = Eigen::Vector2d::Zero();  // [px]
  double sigma = 0;  // largest standard deviation of any direction, if measurements err as they say [px]
  double gain = 0;   // what the change takes off the cost
};

// A parabola through eight trials about the camera that the rays are of. Nothing where it has no least, and where four
// of them say that less than `least_gain` is to be gained to the sides and up and down.
std::optional<PrincipalPointEstimate> estimatePrincipalPoint(const LookedAt& at, double least_gain = 0);

// As much of the change as takes off the cost what the estimate says [px]; or nothing of it.
Eigen::Vector2d worthwhile(const LookedAt& at, const PrincipalPointEstimate& estimate);

}  // namespace edgeslam
