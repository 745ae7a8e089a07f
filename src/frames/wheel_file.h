// Where the wheels say that the robot was, beside recorded frames: wheel_odometry.txt.
#pragma once

#include <string>
#include <vector>

#include "wheels/odometry_pose.h"

namespace edgeslam {

// Lines as in TUM RGB-D's trajectories: time stamp [s, or whole ns] of the frames' clock, position x y z [m],
// quaternion x y z w, of the robot's body in the odometry's frame, whose x and y axes are in the floor. A last line
// that a power cut tore is left out. Throws InputError with file and line where one is none, its quaternion is none, or
// its time stamp not after the one before.
std::vector<OdometryPose> readWheelOdometry(const std::string& path);

}  // namespace edgeslam
