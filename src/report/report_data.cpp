#include "report/report_data.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "geometry/median.h"
#include "report/display_frame.h"
#include "report/report_drawings.h"
#include "report/report_map.h"
#include "report/report_published.h"
#include "report/report_scale.h"
#include "report/report_series.h"

namespace edgeslam {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t most_map_points = 250000;
constexpr double farthest = 1e9;  // steps: what is beyond would only bloat the page

void appendPosition(ordered_json& list, const Eigen::Vector3d& position, const Rounding& rounded) {
  for (int i = 0; i < 3; ++i) list.push_back(rounded(position[i]));
}

ordered_json trajectoryJson(const Trajectory& trajectory, const Similarity& display, const Clock& clock,
                            const Rounding& rounded) {
  ordered_json times = ordered_json::array();
  ordered_json positions = ordered_json::array();
  for (std::size_t i = 0; i < trajectory.size(); i += strideFor(trajectory.size(), most_samples)) {
    times.push_back(clock(trajectory[i].time_ns));
    appendPosition(positions, display * trajectory[i].world_T_camera.translation, rounded);
  }
  return {{"times", times}, {"positions", positions}};
}

// The ground truth from first to last frame, thinned.
Trajectory duringRun(const Trajectory& ground_truth, const RunResult& result) {
  Trajectory during;
  if (result.frames.empty()) return during;
  for (const StampedPose& pose : ground_truth) {
    if (pose.time_ns >= result.frames.front().time_ns && pose.time_ns <= result.frames.back().time_ns)
      during.push_back(pose);
  }
  return during;
}

ordered_json keyframesJson(const RunResult& result, const Similarity& display, const Clock& clock,
                           const Rounding& rounded) {
  const Rounding fine(1e-4);
  ordered_json keyframes = ordered_json::array();
  for (const KeyframeRecord& keyframe : result.keyframes) {
    if (keyframe.world != result.main_world) continue;
    const Eigen::Quaterniond rotation = display.rotation * keyframe.world_T_camera.rotation;
    ordered_json position = ordered_json::array();
    appendPosition(position, display * keyframe.world_T_camera.translation, rounded);
    keyframes.push_back({{"id", keyframe.id},
                         {"frame", keyframe.frame_index},
                         {"time", clock(keyframe.time_ns)},
                         {"position", position},
                         {"rotation", {fine(rotation.x()), fine(rotation.y()), fine(rotation.z()), fine(rotation.w())}},
                         {"reason", keyframe.reason}});
  }
  return keyframes;
}

bool canBeDrawn(const Eigen::Vector3d& position) {
  return position.allFinite() && position.cwiseAbs().maxCoeff() < farthest;
}

// Both ends of each line as whole numbers of `step`.
ordered_json lineEnds(const std::vector<MapLineRecord>& lines, const Similarity& display, const Rounding& rounded) {
  ordered_json ends = ordered_json::array();
  for (const MapLineRecord& line : lines) {
    const Eigen::Vector3d from = display * line.from / rounded.step(), to = display * line.to / rounded.step();
    if (!canBeDrawn(from) || !canBeDrawn(to)) continue;
    for (const Eigen::Vector3d* end : {&from, &to}) {
      for (int i = 0; i < 3; ++i) ends.push_back(static_cast<std::int64_t>(std::lround((*end)[i])));
    }
  }
  return ends;
}

// Positions as whole numbers of `step`; `lines` gives the number of points of each line, in the order of the positions.
ordered_json mapJson(const RunResult& result, const Similarity& display, const Rounding& rounded) {
  std::vector<Eigen::Vector3d> cameras;
  for (const StampedPose& keyframe : keyframeTrajectory(result, result.main_world)) {
    cameras.push_back(keyframe.world_T_camera.translation);
  }
  const std::vector<MapPointRecord> points = mapPointsOf(result, result.main_world);
  const std::vector<std::vector<int>> lines = joinChains(points, cameras);
  const std::size_t stride = strideFor(points.size(), most_map_points);
  ordered_json positions = ordered_json::array();
  ordered_json lengths = ordered_json::array();
  ordered_json chains = ordered_json::array();
  ordered_json greys = ordered_json::array();
  ordered_json sigmas = ordered_json::array();
  std::size_t shown = 0;
  for (std::size_t line = 0; line < lines.size(); line += stride) {
    std::size_t length = 0;
    for (const int index : lines[line]) {
      const MapPointRecord& point = points[static_cast<std::size_t>(index)];
      const Eigen::Vector3d position = display * point.position / rounded.step();
      if (!canBeDrawn(position)) continue;
      for (int i = 0; i < 3; ++i) positions.push_back(static_cast<std::int64_t>(std::lround(position[i])));
      greys.push_back(point.grey);
      const float sigma = std::isfinite(point.depth_sigma_ratio) ? point.depth_sigma_ratio : 1.0F;
      sigmas.push_back(std::lround(1000 * std::clamp(sigma, 0.0F, 1.0F)));
      ++length;
    }
    if (length == 0) continue;
    lengths.push_back(length);
    chains.push_back(points[static_cast<std::size_t>(lines[line].front())].chain);
    shown += length;
  }
  return {{"step", rounded.step()},
          {"positions", positions},
          {"lines", lengths},
          {"chains", chains},
          {"greys", greys},
          {"sigmas_permille", sigmas},
          {"points", points.size()},
          {"shown", shown},
          {"straight", lineEnds(mapLinesOf(result, result.main_world), display, rounded)}};
}

ordered_json publishedFor(const RunDescription& description) {
  const std::optional<PublishedErrors> published = publishedErrors(description.sequence);
  return publishedJson(published ? published : publishedErrors(description.input));
}

// Length of the diagonal of the box around the camera's positions, in the display's unit.
double extent(const Trajectory& trajectory, const Similarity& display) {
  Eigen::AlignedBox3d box;
  for (const StampedPose& pose : trajectory) {
    if (pose.world_T_camera.translation.allFinite()) box.extend(display * pose.world_T_camera.translation);
  }
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

double medianFrameInterval(const RunResult& result) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < result.frames.size(); ++i) {
    intervals.push_back(1e-6 * static_cast<double>(result.frames[i].time_ns - result.frames[i - 1].time_ns));
  }
  return medianOr(0.0, std::move(intervals));
}

}  // namespace

ordered_json reportData(const RunResult& result, const RunSummary& summary, const RunDescription& description,
                        const std::optional<Trajectory>& ground_truth) {
  const DisplayFrame frame = displayFrame(result, summary);
  const Similarity& display = frame.display_T_world;
  const Clock clock(result);
  const Trajectory trajectory = finalTrajectory(result, result.main_world);
  const double size = extent(trajectory, display);
  const Rounding rounded(size > 0 && std::isfinite(size) ? size * 1e-5 : 1e-4);

  ordered_json truth;
  if (frame.aligned && ground_truth) {
    Similarity display_T_reference;
    display_T_reference.rotation = frame.display_R_reference;
    truth = trajectoryJson(duringRun(*ground_truth, result), display_T_reference, clock, rounded);
  }
  const Camera& camera = result.camera;
  return {{"summary", summaryJson(summary, result, description)},
          {"published", publishedFor(description)},
          {"worlds_in_words", worldsInWords(summary.worlds)},
          {"aligned", frame.aligned},
          {"unit", frame.aligned ? "m" : "map units"},
          {"axes", {frame.x_name, frame.y_name, frame.z_name}},
          {"camera",
           {{"width", camera.width},
            {"height", camera.height},
            {"fx", camera.fx},
            {"fy", camera.fy},
            {"cx", camera.cx},
            {"cy", camera.cy}}},
          {"trajectory", trajectoryJson(trajectory, display, clock, rounded)},
          {"live", trajectoryJson(liveTrajectory(result, result.main_world), display, clock, rounded)},
          {"truth", truth},
          {"keyframes", keyframesJson(result, display, clock, rounded)},
          {"map", mapJson(result, display, rounded)},
          {"states", stateRunsJson(result, clock)},
          {"frames", framesJson(result, clock)},
          {"stages", stageSeriesJson(result, summary, clock)},
          {"frame_interval_ms", Rounding(1e-2)(medianFrameInterval(result))},
          {"error", errorSeriesJson(summary.errors.trajectory, clock)},
          {"live_error", errorSeriesJson(summary.errors.live, clock)},
          {"drawings", drawingsJson(result, clock)}};
}

}  // namespace edgeslam
