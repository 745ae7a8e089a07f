// Trajectories in TUM format ("time tx ty tz qx qy qz qw", seconds, camera to world) and EuRoC ground truth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/pose.h"

namespace edgeslam {

struct StampedPose {
  std::int64_t time_ns = 0;
  Pose world_T_camera;
};

using Trajectory = std::vector<StampedPose>;

// Throws InputError with file and line for a missing file, too few columns, a value that is not finite, a
// position beyond 1e12, a zero quaternion. Reads TUM files and EuRoC's state_groundtruth_estimate0/data.csv (comma
// separated, nanoseconds, position, quaternion w x y z). Sorted by time.
Trajectory readTrajectory(const std::string& path);

// Text of a TUM file: time stamps with 9 decimals, values with 9 significant digits.
std::string formatTrajectory(const Trajectory& trajectory);

}  // namespace edgeslam
