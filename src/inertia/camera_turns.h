// How a camera turned from frame to frame, by its poses in a map or before a board.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/pose.h"

namespace edgeslam {

struct PosedCamera {
  std::int64_t time_ns = 0;  // the camera's clock
  int world = 0;             // poses of two worlds have nothing to do with each other
  Pose world_T_camera;       // any unit of length
};

struct CameraTurn {
  std::int64_t from_ns = 0, to_ns = 0;
  Eigen::Quaterniond rotation;  // the camera's frame at the first time, R at the second
};

// From each pose to the first one at least `seconds` after it, and at most half as long again, in the same world.
// Times of `poses` ascend. Turns overlap.
std::vector<CameraTurn> cameraTurns(const std::vector<PosedCamera>& poses, double seconds);

double secondsOf(const CameraTurn& turn);

}  // namespace edgeslam
