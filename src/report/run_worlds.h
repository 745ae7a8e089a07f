// The worlds of a run: maps that were not joined, each with a coordinate frame and a unit of length of its own. What a
// figure or a drawing is about is the main world; the others are told beside it and have files of their own.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/trajectory.h"
#include "pipeline/run_result.h"

namespace edgeslam {

struct WorldSummary {
  int world = 0;                 // its number in the run
  std::int64_t final_poses = 0;  // frames with a final pose in it
  std::int64_t keyframes = 0;
  std::int64_t map_points = 0;
  std::int64_t map_lines = 0;
  std::optional<double> first_pose_s;  // from the first frame to the first final pose in it [s]
};

// The main world first, even where it has no pose; then every other one that has a final pose, ascending.
std::vector<WorldSummary> worldsOf(const RunResult& result);

// The worlds that poses were given out in at the time but that are none of `worlds` in the end: they were joined to
// another one, or given up. Ascending.
std::vector<int> formerWorlds(const RunResult& result, const std::vector<WorldSummary>& worlds);

// The frames with a final pose in `world`, those that were given a good live pose in it at the time, its keyframes.
Trajectory finalTrajectory(const RunResult& result, int world);
Trajectory liveTrajectory(const RunResult& result, int world);
Trajectory keyframeTrajectory(const RunResult& result, int world);

std::vector<MapPointRecord> mapPointsOf(const RunResult& result, int world);
std::vector<MapLineRecord> mapLinesOf(const RunResult& result, int world);

bool hasFinalPoseIn(const FrameRecord& frame, int world);
bool hasGoodLivePoseIn(const FrameRecord& frame, int world);

// "3 maps that were not joined: 600 frames in the main one, 116 in others"; empty where there is one.
std::string worldsInWords(const std::vector<WorldSummary>& worlds);

}  // namespace edgeslam
