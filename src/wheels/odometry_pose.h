// A pose of the robot's body by its wheels.
#pragma once

#include <cstdint>

#include "geometry/pose.h"

namespace edgeslam {

struct OdometryPose {
  std::int64_t utime = 0;  // the robot's clock [us]
  Pose local_T_body;       // translation [m]
};

// [ns]
inline std::int64_t timeOf(const OdometryPose& pose) { return pose.utime * 1000; }

// What wheels can say: finite, at most 1e7 m away, a unit quaternion, its time not negative and at most 4e15 us.
bool isUsable(const OdometryPose& pose);

// The same at some time, with what was driven until then.
struct OdometryPlace {
  Pose local_T_body;        // [m]
  std::int64_t piece = -1;  // motion is told between places of one piece only; -1: not known
  double way_m = 0;         // driven in all, there and back counted
  double turn_rad = 0;      // likewise
  double beyond_s = 0;      // the wheels told nothing for so long before it: they are taken to have gone on
};

}  // namespace edgeslam
