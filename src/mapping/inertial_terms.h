// What the inertial unit says of neighbouring keyframes, for their adjustment: how they are turned against each other,
// and how their mean speed changes (adjustment/bundle_inertia.h).
#pragma once

#include <functional>
#include <optional>

#include "adjustment/bundle_adjustment.h"
#include "map/map.h"

namespace edgeslam {

// What happens between three keyframes in a row, in the first one's camera frame: `first` is the change of speed over
// the first stretch less its mean speed, `second` the mean speed over the second stretch, in its own beginning's camera
// frame; both without gravity [m/s].
struct SpeedChange {
  std::array<KeyframeId, 3> keyframes{};
  std::array<double, 2> seconds{};
  Eigen::Vector3d first = Eigen::Vector3d::Zero(), second = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of the sum, first camera's frame, by noise alone
  Matrix36d first_by_bias = Matrix36d::Zero(), second_by_bias = Matrix36d::Zero();  // derivatives by [rate; force]
};

// None where the two stretches before a keyframe were not measured. `camera_R_imu`: the unit's in the camera's frame.
std::optional<SpeedChange> speedChangeTo(const Map& map, const Keyframe& last, const InertialBias& bias,
                                         const Eigen::Quaterniond& camera_R_imu);

// Adds what is known of stretches with a free camera. `is_free`: scale, gravity and biases are adjusted with the
// cameras, from where `alignment` has them, known or not. Keyframes that are not in the problem yet, `camera_of` adds,
// as fixed ones.
void addInertialTerms(const InertialUnit& unit, const InertialAlignment& alignment, bool is_free, const Map& map,
                      const std::vector<KeyframeId>& free, const std::function<int(KeyframeId)>& camera_of,
                      BundleProblem& problem);

}  // namespace edgeslam
