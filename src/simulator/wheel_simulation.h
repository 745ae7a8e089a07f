// What the wheels of a robot that carries the simulated camera would say: along the exact motion, as far as it is in
// the floor's plane, with the errors of a small robot.
#pragma once

#include <string>
#include <vector>

#include "simulator/simulator.h"
#include "wheels/odometry_pose.h"

namespace edgeslam {

constexpr double simulated_wheel_rate_hz = 50;

// Poses of the camera by the wheels, from the first frame to just after the last one, every 1 / simulated_wheel_rate_hz
// seconds. In the frames that options.slipped names the wheels spin.
std::vector<OdometryPose> simulateWheels(const SimulatedSequence& sequence);

// Text of wheel_odometry.txt (frames/wheel_file.h).
std::string formatWheelOdometry(const std::vector<OdometryPose>& poses);

}  // namespace edgeslam
