// The figures of a run: how many frames got a pose, how long each stage took, how far off the trajectory is. Poses,
// coverage, errors, keyframes and points are those of the main world (run_worlds.h).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/evaluation.h"
#include "pipeline/run_result.h"
#include "report/run_description.h"
#include "report/run_worlds.h"

namespace edgeslam {

// Over the frames in which the stage ran [ms].
struct StageSummary {
  std::string name;
  std::int64_t frames = 0;
  double mean = 0, median = 0, percentile_99 = 0, max = 0;
};

// After similarity alignment to the ground truth; empty where there is no ground truth or too few poses match it.
struct RunErrors {
  std::optional<AbsoluteError> trajectory;  // final poses of all frames
  std::optional<AbsoluteError> live;        // poses as given out at the time
  std::optional<AbsoluteError> keyframes;
};

// Of the keyframes up to a closed loop, before and after it; none where they cannot be compared.
struct LoopErrors {
  std::optional<AbsoluteError> before, after;
};

struct RunSummary {
  std::int64_t frames = 0;
  std::int64_t unreadable_frames = 0;
  std::int64_t final_poses = 0;                  // lines of trajectory.txt
  std::int64_t live_poses = 0;                   // lines of trajectory_live.txt
  std::map<TrackingState, std::int64_t> states;  // every state, 0 where it did not occur
  std::vector<WorldSummary> worlds;              // the main one first
  double coverage = 0;                           // share of the frames from the first final pose on that have one
  std::optional<double> first_pose_s;            // from the first frame to the first final pose [s]
  std::optional<double> first_live_pose_s;       // from the first frame to the first good live pose [s]
  double recording_s = 0;                        // from the first frame to the last [s]
  double wall_s = 0;
  double real_time_ratio = 0;        // recording_s over wall_s: above 1 is faster than real time
  std::vector<StageSummary> stages;  // in the order of a frame; last "tracking" (the sum of a frame's own) and "total"
  std::optional<StageSummary> latency;  // of a live run: from capture to the pose
  std::optional<double>
      share_in_time;  // of a live run: frames with a result before the next was due, over all captured
  bool has_ground_truth = false;
  RunErrors errors;
  std::vector<LoopErrors> loops;  // by closed loop
  std::string recording_quality;  // what is wrong with the recording, or empty (recording_quality.h)
};

RunSummary summarise(const RunResult& result, const std::optional<Trajectory>& ground_truth);

// The object that summary.json holds.
nlohmann::ordered_json summaryJson(const RunSummary& summary, const RunResult& result,
                                   const RunDescription& description);

}  // namespace edgeslam
