// How the wheels say that the camera moved between two times, and how well they know it.
#pragma once

#include <optional>

#include "wheels/odometry_pose.h"

namespace edgeslam {

struct WheelOptions {
  Pose body_T_camera;   // [m]
  bool planar = false;  // the body stays in a plane: how it tilts and rises is known better, though not for sure
};

struct WheelMotion {
  Pose first_T_second;                     // of the camera [m]
  Matrix6d covariance = Matrix6d::Zero();  // of its right-hand update [translation; rotation] [m], [rad]
};

// None where the two are not of one piece. The covariance is that of wheels that roll: it grows with the way and the
// turn. Of tilting and rising, out of the plane in which the odometry's frame has its x and y axes, wheels say less.
std::optional<WheelMotion> wheelMotion(const WheelOptions& options, const OdometryPlace& first,
                                       const OdometryPlace& second);

}  // namespace edgeslam
