// A pose of the robot's body by its wheels.
#pragma once

#include <cstdint>

#include "geometry/pose.h"

namespace edgeslam {

struct OdometryPose {
  std::int64_t utime = 0;  // the robot's clock [us]
  Pose local_T_body;       // translation [m]
};

}  // namespace edgeslam
