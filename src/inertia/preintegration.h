// The motion between two times as inertia alone tells it, apart from gravity and from the speed at its beginning, which
// it cannot know (Forster, Carlone, Dellaert, Scaramuzza, On-Manifold Preintegration for Real-Time Visual-Inertial
// Odometry, 2017, sections V and VI).
#pragma once

#include "inertia/inertial_unit.h"

namespace edgeslam {

using Matrix9d = Eigen::Matrix<double, 9, 9>;
using Matrix96d = Eigen::Matrix<double, 9, 6>;

// With world_R, position P and velocity V of the unit at the beginning, and gravity g [m/s^2], after `seconds` T:
//   world_R' = world_R rotation,   V' = V + g T + world_R velocity,   P' = P + V T + g T^2 / 2 + world_R position.
// Errors are [rotation vector [rad], applied on the right of `rotation`; velocity; position].
struct PreintegratedMotion {
  double seconds = 0;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // the unit's frame at the beginning, R at the end
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();            // [m/s], the unit's frame at the beginning
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            // [m], likewise
  InertialBias bias;                                             // that was taken off
  Matrix96d by_bias = Matrix96d::Zero();                         // derivative by [rate; force] of the bias
  Matrix9d covariance = Matrix9d::Zero();                        // by noise alone
};

// From one sample to the next: what is measured between them is their mean.
PreintegratedMotion preintegrate(const InertialUnit& unit, const InertialSample& from, const InertialSample& to,
                                 const InertialBias& bias);

// The same motion with another bias, to the first order.
PreintegratedMotion withBias(const PreintegratedMotion& motion, const InertialBias& bias);

// One motion after another, with the second one's bias.
PreintegratedMotion joined(const PreintegratedMotion& first, const PreintegratedMotion& second);

// What is left of a motion after its first part: joined(first, remainder(whole, first)) is the whole.
PreintegratedMotion remainder(const PreintegratedMotion& whole, const PreintegratedMotion& first);

}  // namespace edgeslam
