// The figures of a finished run, read from the summary.json that it left.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "edgeslam/input_error.h"
#include "geometry/similarity.h"

namespace edgeslam {

struct ErrorFigures {
  std::int64_t pairs = 0;
  double rmse_m = 0, mean_m = 0, median_m = 0, max_m = 0;
  std::optional<Similarity> reference_T_world;  // of runs that tell it
};

struct LoopFigures {
  std::int64_t frame = 0;
  std::string how;
  std::optional<ErrorFigures> before, after;  // of the keyframes up to it
};

// Over the frames in which the stage ran [ms].
struct StageFigures {
  std::string name;
  std::int64_t frames = 0;
  double mean = 0, median = 0, percentile_99 = 0, max = 0;
};

struct RunFigures {
  std::string sequence, input, command_line, initialisation;
  std::string program_version;
  std::map<std::string, std::string> library_versions;
  std::string configuration;  // text of the one in effect
  std::int64_t frames = 0, unreadable = 0, dropped = 0, with_pose = 0, with_live_pose = 0;
  std::map<std::string, std::int64_t> states;  // frames in each
  double coverage = 0;                         // share of the frames from the first pose on
  std::int64_t worlds = 1;                     // maps that were not joined; all other figures are of the main one
  std::int64_t with_pose_in_any_world = 0;     // frames
  std::optional<double> first_pose_s, first_live_pose_s;
  std::int64_t keyframes = 0, map_points = 0, recoveries = 0, relocalisations = 0;
  std::vector<LoopFigures> loops;
  bool has_ground_truth = false;
  std::optional<ErrorFigures> trajectory, live, at_keyframes;
  std::vector<StageFigures> stages;  // in the order of a frame
  double recording_s = 0, wall_s = 0, real_time_ratio = 0;
};

// Shares of all frames: with a pose in the main world, and in any.
double posedShare(const RunFigures& run);
double posedShareInAnyWorld(const RunFigures& run);

// The stage of that name, or null.
const StageFigures* stageOf(const RunFigures& run, const std::string& name);

// Reads `folder`/summary.json. Throws InputError with file, key and what was expected where the file is missing, over
// 64 MiB, no JSON (with its line), or a key is missing, of another type, not finite or impossible.
RunFigures readRunFigures(const std::string& folder);

}  // namespace edgeslam
