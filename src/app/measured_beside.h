// What an inertial unit and the wheels measured beside recorded frames, for a replay that is to use them.
#pragma once

#include <vector>

#include "configuration/configuration.h"
#include "frames/frame_source.h"
#include "inertia/inertial_unit.h"
#include "wheels/odometry_pose.h"

namespace edgeslam {

struct MeasuredBeside {
  std::vector<InertialSample> inertia;
  std::vector<OdometryPose> wheels;
};

// What the command line asks for, beside the configuration.
struct MeasuredUse {
  bool imu = false;
  bool wheels = false;
  bool is_live = false;
};

// With the settings to use it; empty where it is not to be used, which is told where it is there. What was measured of
// a recording is among the decisions that are repeated. Throws InputError where what is asked for is not there, or does
// not go together.
MeasuredBeside measuredBeside(const FrameSource& source, const MeasuredUse& use, Configuration& configuration);

}  // namespace edgeslam
