// What frames in a row say of how an inertial unit is turned against the camera: with which rotation the gyroscope
// turned as the camera did (inertia/turn_fit.h).
#pragma once

#include <optional>
#include <vector>

#include "inertia/camera_turns.h"
#include "inertia/inertial_unit.h"

namespace edgeslam {

struct UnitRotationEstimate {
  Eigen::Vector3d change = Eigen::Vector3d::Zero();      // on the right of the imu_R_camera that is given [rad]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of it [rad^2]
  double seconds = 0;                                    // of turns that both measured
};

// Of poses of frames in a row only the rotations count. What turns do not tell of it, as about the axis of all of them,
// stays as `unit` has it, which is taken to be known to some degrees. `near`: where to begin. Nothing where the turns
// tell too little, or the clocks differ otherwise than `unit` says: that is found first.
std::optional<UnitRotationEstimate> estimateUnitRotation(const std::vector<PosedCamera>& frames,
                                                         const std::vector<InertialSample>& samples,
                                                         const InertialUnit& unit, const Eigen::Quaterniond& near);

}  // namespace edgeslam
