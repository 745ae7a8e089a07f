// How an inertial unit is turned against the camera, as a run found it.
#pragma once

#include <optional>

#include "geometry/angles.h"
#include "inertia/inertial_unit.h"

namespace edgeslam {

struct FoundUnitRotation {
  Eigen::Quaterniond imu_R_camera = Eigen::Quaterniond::Identity();  // as InertialUnit::imu_T_camera's
  double sigma_rad = 0;                                              // standard deviation about the worst axis
};

// The unit as it is turned by what was found; where the camera is in its frame stays.
inline InertialUnit turnedAsFound(InertialUnit unit, const std::optional<FoundUnitRotation>& found) {
  if (found) unit.imu_T_camera.rotation = found->imu_R_camera;
  return unit;
}

// What is farther from the rotation that is given is told, and not used: it is another calibration's.
constexpr double farthest_unit_rotation = radians(5.0);

}  // namespace edgeslam
