// The table of frames that a finished run left, frames.csv.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/trajectory.h"

namespace edgeslam {

struct FrameRow {
  std::int64_t index = 0;
  std::int64_t time_ns = 0;
  std::string state, reason;
  std::optional<Pose> final_pose;  // in the run's main world: camera to world, map units
  double time_ms = 0;              // of all its stages but mapping and places, as summary.json's "tracking"
};

// Reads `folder`/frames.csv. Throws InputError with file, line and column where it is missing, over 1 GiB, cut off, has
// other columns than it is to have, a number is none or not finite, or the frames' numbers or times do not increase.
// Final poses in other worlds than the main one are left out; a table without worlds has one.
std::vector<FrameRow> readFrameTable(const std::string& folder);

// The frames that have a final pose.
Trajectory finalTrajectory(const std::vector<FrameRow>& frames);

}  // namespace edgeslam
