// A robot that drives on a circle, with a camera mounted on it.
#pragma once

#include <cmath>
#include <cstdint>

#include "geometry/pose.h"

namespace edgeslam {

constexpr double robot_frame_s = 0.05;     // from frame to frame
constexpr double robot_metres_a_unit = 2;  // of the map

// Where the camera is on it [m].
inline const Pose robot_T_camera{Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.1, 0.02, 0.3}};

// Where the robot is once it has turned by `angle_rad` from the origin on, on a circle of one metre's radius [m].
inline Pose onCircle(double angle_rad) {
  return {rotationExp(angle_rad * Eigen::Vector3d::UnitZ()), {std::sin(angle_rad), 1 - std::cos(angle_rad), 0}};
}

inline std::int64_t nanoseconds(double time_s) { return std::llround(time_s * 1e9); }

}  // namespace edgeslam
