#include "report/report_series.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

namespace edgeslam {

using nlohmann::ordered_json;

namespace {

// Numbers of the frames that begin a stretch of equal state, and of equal reason too where `by_reason`; at the end the
// number of frames.
std::vector<std::size_t> stretches(const RunResult& result, bool by_reason) {
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    const FrameRecord& frame = result.frames[i];
    const FrameRecord& before = result.frames[begins.empty() ? 0 : begins.back()];
    if (i == 0 || frame.state != before.state ||
        hasFinalPoseIn(frame, result.main_world) != hasFinalPoseIn(before, result.main_world) ||
        (by_reason && frame.reason != before.reason)) {
      begins.push_back(i);
    }
  }
  begins.push_back(result.frames.size());
  return begins;
}

bool ranAnywhere(const RunSummary& summary, Stage stage) {
  return std::any_of(summary.stages.begin(), summary.stages.end(),
                     [&](const StageSummary& ran) { return ran.name == stageName(stage); });
}

}  // namespace

// Reasons that change with every frame of a long run are given only where they begin.
ordered_json stateRunsJson(const RunResult& result, const Clock& clock) {
  std::vector<std::size_t> begins = stretches(result, true);
  if (begins.size() > most_samples) begins = stretches(result, false);
  ordered_json runs = ordered_json::array();
  for (std::size_t i = 0; i + 1 < begins.size(); ++i) {
    const FrameRecord& first = result.frames[begins[i]];
    const FrameRecord& after = result.frames[std::min(begins[i + 1], result.frames.size() - 1)];
    runs.push_back({{"from", clock(first.time_ns)},
                    {"to", clock(after.time_ns)},
                    {"state", stateName(first.state)},
                    {"reason", first.reason},
                    {"final_pose", hasFinalPoseIn(first, result.main_world)},
                    {"first_frame", first.index},
                    {"frames", begins[i + 1] - begins[i]}});
  }
  return runs;
}

ordered_json framesJson(const RunResult& result, const Clock& clock) {
  ordered_json times = ordered_json::array();
  ordered_json tracked = ordered_json::array();
  ordered_json mapped = ordered_json::array();
  for (std::size_t i = 0; i < result.frames.size(); i += strideFor(result.frames.size(), most_samples)) {
    times.push_back(clock(result.frames[i].time_ns));
    tracked.push_back(result.frames[i].tracked_points);
    mapped.push_back(result.frames[i].mapped_points);
  }
  return {{"times", times}, {"tracked", tracked}, {"mapped", mapped}};
}

// Of each stage the mean over the frames that one column of the chart stands for.
ordered_json stageSeriesJson(const RunResult& result, const RunSummary& summary, const Clock& clock) {
  const Rounding fine(1e-2);
  const std::size_t stride = strideFor(result.frames.size(), most_samples / 2);
  ordered_json times = ordered_json::array();
  ordered_json names = ordered_json::array();
  ordered_json series = ordered_json::array();
  for (std::size_t i = 0; i < result.frames.size(); i += stride) times.push_back(clock(result.frames[i].time_ns));
  for (const Stage stage : all_stages) {
    if (!ranAnywhere(summary, stage)) continue;
    names.push_back(stageName(stage));
    ordered_json values = ordered_json::array();
    for (std::size_t i = 0; i < result.frames.size(); i += stride) {
      const std::size_t end = std::min(i + stride, result.frames.size());
      double sum = 0;
      for (std::size_t j = i; j < end; ++j) {
        sum += result.frames[j].times[stage];
      }
      values.push_back(fine(sum / static_cast<double>(end - i)));
    }
    series.push_back(std::move(values));
  }
  return {{"times", times}, {"names", names}, {"series", series}, {"frames_per_sample", stride}};
}

ordered_json errorSeriesJson(const std::optional<AbsoluteError>& error, const Clock& clock) {
  if (!error) return nullptr;
  const Rounding fine(1e-4);
  ordered_json times = ordered_json::array();
  ordered_json errors = ordered_json::array();
  for (std::size_t i = 0; i < error->errors.size(); i += strideFor(error->errors.size(), most_samples)) {
    times.push_back(clock(error->times_ns[i]));
    errors.push_back(fine(100 * error->errors[i]));
  }
  return {{"times", times}, {"errors_cm", errors}};
}

}  // namespace edgeslam
