// What a camera's way through its map and the accelerometer say together: the accelerometer's bias, and how far the
// unit is from the camera; beside the map's unit of length and the direction of gravity, which are unknown as well.
#pragma once

#include <optional>
#include <vector>

#include "inertia/camera_turns.h"
#include "inertia/inertial_unit.h"

namespace edgeslam {

struct ForceFit {
  Eigen::Vector3d bias = Eigen::Vector3d::Zero(), bias_sigma = Eigen::Vector3d::Zero();  // the unit's frame [m/s^2]
  // Where the camera is in the unit's frame, as imu_T_camera.translation [m].
  Eigen::Vector3d imu_t_camera = Eigen::Vector3d::Zero(), imu_t_camera_sigma = Eigen::Vector3d::Zero();
  double metres_a_unit = 1, scale_sigma = 0;     // of the map; the deviation as a share of it
  bool tells_bias = false, tells_place = false;  // these are known well enough to be of use
};

// `unit`: with rotation and offset as they were found, and its place as far as it is known, to some centimetres.
// `rotation_covariance`: of this rotation, a small one on the right of imu_T_camera.rotation [rad^2]: gravity that is
// turned wrongly looks like a bias. `rate_bias`: of the gyroscope [rad/s]. Of several worlds the one with most poses
// counts. None where it says too little to fit anything.
std::optional<ForceFit> fitForces(const std::vector<PosedCamera>& poses, const std::vector<InertialSample>& samples,
                                  const InertialUnit& unit, const Eigen::Matrix3d& rotation_covariance,
                                  const Eigen::Vector3d& rate_bias);

}  // namespace edgeslam
