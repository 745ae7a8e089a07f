#include "app/replay_outcome.h"

#include <algorithm>
#include <cstdio>

#include "edgeslam/input_error.h"
#include "evaluation/evaluation.h"
#include "report/report.h"

namespace edgeslam {
namespace {

struct PosedFrames {
  Trajectory trajectory;
  std::size_t first = 0;  // the number of frames where none has a pose
};

PosedFrames posedFrames(const RunResult& result) {
  PosedFrames posed;
  posed.first = result.frames.size();
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    const FrameRecord& frame = result.frames[i];
    if (!frame.has_final_pose) continue;
    posed.first = std::min(posed.first, i);
    posed.trajectory.push_back({frame.time_ns, frame.final_world_T_camera});
  }
  return posed;
}

void tellFrames(const RunResult& result) {
  const auto& frames = result.frames;
  const double seconds =
      frames.empty() ? 0 : static_cast<double>(frames.back().time_ns - frames.front().time_ns) * 1e-9;
  std::printf("%zu frames (%.1f s) in %.1f s: %.2f x real time\n", frames.size(), seconds, result.wall_s,
              seconds / std::max(1e-9, result.wall_s));
  if (result.unreadable_frames > 0)
    std::printf("%lld frames could not be read and were skipped\n", static_cast<long long>(result.unreadable_frames));
  if (result.dropped_frames > 0)
    std::printf("%lld frames were dropped, newer ones being there\n", static_cast<long long>(result.dropped_frames));
}

void tellError(const Trajectory& estimate, const Trajectory& ground_truth) {
  try {
    const AbsoluteError error = absoluteError(estimate, ground_truth, Alignment::similarity);
    std::printf("absolute trajectory error %.2f cm (RMSE of %d poses after similarity alignment)\n",
                100 * error.translation.rmse, error.pairs);
  } catch (const InputError& problem) {
    std::printf("no error figure: %s\n", problem.what());
  }
}

}  // namespace

void tellOutcome(const RunResult& result, const std::optional<Trajectory>& ground_truth, const std::string& output) {
  tellFrames(result);
  const PosedFrames posed = posedFrames(result);
  if (posed.trajectory.empty()) {
    std::printf("no pose: %s\n", result.frames.empty() ? "no frame" : result.frames.back().reason.c_str());
    return;
  }
  std::printf("map started by %s\n", result.initialisation.c_str());
  const double share =
      static_cast<double>(posed.trajectory.size()) / static_cast<double>(result.frames.size() - posed.first);
  std::printf("poses for %zu frames, %.1f %% from the first pose on; %zu keyframes, %zu map points\n",
              posed.trajectory.size(), 100.0 * share, result.keyframes.size(), result.map_points.size());
  for (const std::string& event : result.events) std::printf("%s\n", event.c_str());
  if (ground_truth) tellError(posed.trajectory, *ground_truth);
  if (reportsAreBuiltIn()) {
    std::printf("%s/report.html shows it all\n", output.c_str());
  } else {
    std::printf("results are in %s; this build makes no report.html\n", output.c_str());
  }
}

}  // namespace edgeslam
