// How an inertial unit sits on a camera and how their clocks differ, roughly and with nothing to begin with: for each
// of many offsets, the rotation that takes the camera's rates of turning best to the gyroscope's (Kabsch, A Solution
// for the Best Rotation to Relate Two Sets of Vectors, 1976), and of these the one that fits best.
#pragma once

#include <vector>

#include "inertia/camera_turns.h"
#include "inertia/inertial_unit.h"
#include "inertia/turn_fit.h"

namespace edgeslam {

struct TurnAlignment {
  std::size_t turns = 0;   // that both measured; too few of them, and what follows means nothing
  double offset_s = 0;     // as InertialUnit::offset_ns
  bool is_at_end = false;  // an offset beyond those that were tried fits better
  Eigen::Quaterniond imu_R_camera = Eigen::Quaterniond::Identity();
  Eigen::Vector3d rate_bias = Eigen::Vector3d::Zero();  // the unit's frame [rad/s]
  // Axes of the camera's turning, columns in the camera's frame, and the rates about them that both measured alike
  // [rad/s, rms about the mean]: descending.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d common_rates = Eigen::Vector3d::Zero();
  // By how much the rates of both differ [rad/s, rms], and by how much at least were the unit's axes a mirror's.
  double difference = 0, mirrored_difference = 0;
};

constexpr double longest_offset_tried_s = 0.5;

// Offsets up to longest_offset_tried_s about `offset_s`, which is what is known of it.
TurnAlignment alignTurns(const std::vector<CameraTurn>& turns, const std::vector<InertialSample>& samples,
                         double offset_s);

}  // namespace edgeslam
