#include "report/run_summary.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "edgeslam/input_error.h"
#include "report/recording_quality.h"

namespace edgeslam {
namespace {

using nlohmann::ordered_json;

constexpr std::array<TrackingState, 6> all_states{TrackingState::initialising, TrackingState::tracking,
                                                  TrackingState::predicted,    TrackingState::recovered,
                                                  TrackingState::relocalised,  TrackingState::lost};

double seconds(std::int64_t nanoseconds) { return 1e-9 * static_cast<double>(nanoseconds); }

// Nearest-rank quantile of sorted values.
double quantile(const std::vector<double>& sorted, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

StageSummary summaryOf(const std::string& name, std::vector<double> times) {
  std::sort(times.begin(), times.end());
  double sum = 0;
  for (const double time : times) sum += time;
  const auto count = static_cast<std::int64_t>(times.size());
  return {name, count, sum / static_cast<double>(count), quantile(times, 0.5), quantile(times, 0.99), times.back()};
}

std::vector<StageSummary> allStages(const RunResult& result) {
  std::map<Stage, std::vector<double>> times;
  std::vector<double> tracking, totals;
  for (const FrameRecord& frame : result.frames) {
    for (const Stage stage : all_stages) {
      if (frame.times.ran(stage)) times[stage].push_back(frame.times[stage]);
    }
    const double total = frame.times.total();
    if (!(total > 0)) continue;
    tracking.push_back(total - frame.times[Stage::mapping] - frame.times[Stage::places]);
    totals.push_back(total);
  }
  std::vector<StageSummary> stages;
  stages.reserve(times.size() + 2);
  for (auto& [stage, values] : times) stages.push_back(summaryOf(stageName(stage), std::move(values)));
  if (totals.empty()) return stages;
  stages.push_back(summaryOf("tracking", std::move(tracking)));
  stages.push_back(summaryOf("total", std::move(totals)));
  return stages;
}

std::optional<StageSummary> latencyOf(const RunResult& result) {
  std::vector<double> latencies;
  for (const FrameRecord& frame : result.frames) {
    if (frame.latency_ms >= 0) latencies.push_back(frame.latency_ms);
  }
  if (latencies.empty()) return std::nullopt;
  return summaryOf("latency", std::move(latencies));
}

// Of all frames captured, dropped ones included: how many had their pose before the next one was due.
std::optional<double> shareInTime(const RunResult& result) {
  const auto count = static_cast<std::int64_t>(result.frames.size());
  if (count < 2 || result.pace <= 0) return std::nullopt;
  const std::int64_t captured = count + result.dropped_frames;
  const double interval_ms = 1e-6 * static_cast<double>(result.frames.back().time_ns - result.frames.front().time_ns) /
                             static_cast<double>(captured - 1) / result.pace;
  const auto in_time = std::count_if(result.frames.begin(), result.frames.end(), [&](const FrameRecord& frame) {
    return frame.latency_ms >= 0 && static_cast<double>(frame.latency_ms) <= interval_ms;
  });
  return static_cast<double>(in_time) / static_cast<double>(captured);
}

ordered_json timesJson(const StageSummary& times) {
  return {{"frames", times.frames},
          {"mean", times.mean},
          {"p50", times.median},
          {"p99", times.percentile_99},
          {"max", times.max}};
}

// Too few poses to compare is a result, not bad input, when a run is summed up.
std::optional<AbsoluteError> errorIfComparable(const Trajectory& estimate, const Trajectory& reference) {
  try {
    AbsoluteError error = absoluteError(estimate, reference, Alignment::similarity);
    if (!std::isfinite(error.translation.rmse)) return std::nullopt;
    return error;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

Trajectory trajectoryOf(const std::vector<TimedPose>& poses) {
  Trajectory trajectory;
  for (const TimedPose& pose : poses) trajectory.push_back({pose.time_ns, pose.world_T_camera});
  return trajectory;
}

ordered_json errorJson(const std::optional<AbsoluteError>& error) {
  if (!error) return nullptr;
  const Eigen::Quaterniond& q = error->reference_T_estimate.rotation;
  const Eigen::Vector3d& t = error->reference_T_estimate.translation;
  return {{"pairs", error->pairs},
          {"rmse_m", error->translation.rmse},
          {"mean_m", error->translation.mean},
          {"median_m", error->translation.median},
          {"max_m", error->translation.max},
          {"scale", error->reference_T_estimate.scale},
          {"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"translation_m", {t.x(), t.y(), t.z()}}};
}

ordered_json optionalJson(const std::optional<double>& value) { return value ? ordered_json(*value) : ordered_json(); }

ordered_json worldsJson(const RunSummary& summary) {
  ordered_json worlds = ordered_json::array();
  for (const WorldSummary& world : summary.worlds) {
    worlds.push_back({{"world", world.world},
                      {"frames_with_pose", world.final_poses},
                      {"first_pose_s", optionalJson(world.first_pose_s)},
                      {"keyframes", world.keyframes},
                      {"map_points", world.map_points},
                      {"map_lines", world.map_lines}});
  }
  return worlds;
}

// Null: none was found, or it is as it was given.
ordered_json timeOffsetJson(const std::optional<FoundTimeOffset>& found) {
  if (!found) return nullptr;
  return {{"time_offset_s", 1e-9 * static_cast<double>(found->offset_ns)}, {"sigma_s", found->sigma_s}};
}

// Likewise.
ordered_json unitRotationJson(const std::optional<FoundUnitRotation>& found) {
  if (!found) return nullptr;
  const Eigen::Quaterniond& q = found->imu_R_camera;
  return {{"quaternion", {q.w(), q.x(), q.y(), q.z()}}, {"sigma_deg", degrees(found->sigma_rad)}};
}

}  // namespace

RunSummary summarise(const RunResult& result, const std::optional<Trajectory>& ground_truth) {
  RunSummary summary;
  summary.frames = static_cast<std::int64_t>(result.frames.size());
  summary.unreadable_frames = result.unreadable_frames;
  summary.worlds = worldsOf(result);
  summary.recording_quality = recordingQuality(result);
  for (const TrackingState state : all_states) summary.states[state] = 0;
  std::int64_t frames_from_first_pose = 0;
  for (const FrameRecord& frame : result.frames) {
    const double since_start = seconds(frame.time_ns - result.frames.front().time_ns);
    ++summary.states[frame.state];
    if (hasFinalPoseIn(frame, result.main_world)) {
      ++summary.final_poses;
      if (!summary.first_pose_s) summary.first_pose_s = since_start;
    }
    if (summary.first_pose_s) ++frames_from_first_pose;
    if (hasGoodLivePoseIn(frame, result.main_world)) {
      ++summary.live_poses;
      if (!summary.first_live_pose_s) summary.first_live_pose_s = since_start;
    }
  }
  if (frames_from_first_pose > 0) {
    summary.coverage = static_cast<double>(summary.final_poses) / static_cast<double>(frames_from_first_pose);
  }
  if (!result.frames.empty()) {
    summary.recording_s = seconds(result.frames.back().time_ns - result.frames.front().time_ns);
  }
  summary.wall_s = result.wall_s;
  if (result.wall_s > 0) summary.real_time_ratio = summary.recording_s / result.wall_s;
  summary.stages = allStages(result);
  summary.latency = latencyOf(result);
  summary.share_in_time = shareInTime(result);
  summary.has_ground_truth = ground_truth.has_value();
  if (ground_truth) {
    summary.errors.trajectory = errorIfComparable(finalTrajectory(result, result.main_world), *ground_truth);
    summary.errors.live = errorIfComparable(liveTrajectory(result, result.main_world), *ground_truth);
    summary.errors.keyframes = errorIfComparable(keyframeTrajectory(result, result.main_world), *ground_truth);
    for (const ClosedLoop& loop : result.closed_loops) {
      summary.loops.push_back({errorIfComparable(trajectoryOf(loop.before), *ground_truth),
                               errorIfComparable(trajectoryOf(loop.after), *ground_truth)});
    }
  }
  return summary;
}

ordered_json summaryJson(const RunSummary& summary, const RunResult& result, const RunDescription& description) {
  ordered_json states = ordered_json::object();
  for (const auto& [state, count] : summary.states) states[stateName(state)] = count;
  ordered_json stages = ordered_json::object();
  for (const StageSummary& stage : summary.stages) {
    stages[stage.name] = timesJson(stage);
  }
  ordered_json loops = ordered_json::array();
  for (std::size_t i = 0; i < result.closed_loops.size(); ++i) {
    const ClosedLoop& loop = result.closed_loops[i];
    loops.push_back({{"frame", loop.frame_index}, {"keyframe", loop.keyframe}, {"how", loop.how}});
    if (i >= summary.loops.size()) continue;
    loops.back()["keyframe_error_before"] = errorJson(summary.loops[i].before);
    loops.back()["keyframe_error_after"] = errorJson(summary.loops[i].after);
  }
  ordered_json errors;
  if (summary.has_ground_truth) {
    errors = {{"alignment", "similarity"},
              {"trajectory", errorJson(summary.errors.trajectory)},
              {"live", errorJson(summary.errors.live)},
              {"keyframes", errorJson(summary.errors.keyframes)}};
  }
  ordered_json threads = ordered_json::object();
  for (const DurationSummary& times : result.thread_durations) {
    threads[times.name] = {{"count", times.count},
                           {"mean", times.mean},
                           {"p50", times.median},
                           {"p99", times.percentile_99},
                           {"max", times.max}};
  }
  return {{"sequence", description.sequence},
          {"input", description.input},
          {"command_line", description.command_line},
          {"frames",
           {{"total", summary.frames},
            {"unreadable", summary.unreadable_frames},
            {"dropped", result.dropped_frames},
            {"with_pose", summary.final_poses},
            {"with_live_pose", summary.live_poses}}},
          {"states", states},
          {"worlds", worldsJson(summary)},
          {"coverage_from_first_pose", summary.coverage},
          {"first_pose_s", optionalJson(summary.first_pose_s)},
          {"first_live_pose_s", optionalJson(summary.first_live_pose_s)},
          {"keyframes", summary.worlds.front().keyframes},
          {"map_points", summary.worlds.front().map_points},
          {"map_lines", summary.worlds.front().map_lines},
          {"initialisation", result.initialisation},
          {"imu_time_offset", timeOffsetJson(result.time_offset)},
          {"imu_rotation", unitRotationJson(result.unit_rotation)},
          {"recoveries", result.recoveries},
          {"relocalisations", result.relocalisations},
          {"loops", result.closed_loops.size()},
          {"closed_loops", loops},
          {"events", result.events},
          {"recording_quality", summary.recording_quality},
          {"absolute_trajectory_error", errors},
          {"stage_times_ms", stages},
          {"thread_durations_ms", threads},
          {"latency_ms", summary.latency ? timesJson(*summary.latency) : ordered_json()},
          {"share_within_frame_interval", optionalJson(summary.share_in_time)},
          {"recording_s", summary.recording_s},
          {"wall_s", summary.wall_s},
          {"real_time_ratio", summary.real_time_ratio},
          {"versions", {{"edgeslam", description.program_version}, {"libraries", description.library_versions}}},
          {"configuration", description.configuration}};
}

}  // namespace edgeslam
