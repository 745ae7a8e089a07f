// What a live run decided by the clock, and what is therefore needed to repeat it: which frames were passed over, which
// frames told mapping nothing, which update of the map tracking took before which frame, and what an inertial unit and
// the wheels had measured until then, which correction mapping applied before which message.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "inertia/inertial_unit.h"
#include "wheels/odometry_pose.h"

namespace edgeslam {

struct RunDecisions {
  std::map<std::int64_t, std::int64_t> updates;                   // by frame: the update taken before it
  std::set<std::int64_t> mapping_busy;                            // frames
  std::map<std::int64_t, std::vector<std::int64_t>> corrections;  // by message: those applied before it, in order
  std::map<std::int64_t, std::vector<InertialSample>> inertia;    // by frame: what was measured until then
  std::map<std::int64_t, std::vector<OdometryPose>> wheels;       // likewise
  std::set<std::int64_t> snapshots;                               // that places worked on: numbers of the corrections
};

}  // namespace edgeslam
