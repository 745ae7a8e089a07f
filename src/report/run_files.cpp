#include "report/run_files.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "files/file_set.h"
#include "files/format_text.h"
#include "report/ply.h"
#include "report/report.h"
#include "report/run_summary.h"

namespace edgeslam {
namespace {

// Empty for a value that is not finite.
std::string number(const char* format, double value) { return std::isfinite(value) ? formatted(format, value) : ""; }

// Exact, which a double of seconds would not be.
std::string secondsWithNanoseconds(std::int64_t time_ns) {
  constexpr std::int64_t billion = 1000000000;
  std::int64_t whole = time_ns / billion;
  std::int64_t rest = time_ns % billion;
  const bool negative = time_ns < 0;
  whole = negative ? -whole : whole;
  rest = negative ? -rest : rest;
  std::string fraction = std::to_string(rest);
  fraction.insert(0, 9 - fraction.size(), '0');
  return (negative ? "-" : "") + std::to_string(whole) + "." + fraction;
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + "\"";
}

void appendPose(std::string& row, bool present, const Pose& pose) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
    row += "," + (present ? number("%.9g", value) : std::string());
  }
}

void appendStandardDeviations(std::string& row, const FrameRecord& frame) {
  for (int i = 0; i < 6; ++i) {
    const double deviation = standardDeviation(frame)[i];
    row += "," + (frame.has_pose && deviation > 0 ? number("%.6g", deviation) : std::string());
  }
}

// Those that ran in any frame.
std::vector<Stage> stagesOf(const RunResult& result) {
  std::vector<Stage> stages;
  for (const Stage stage : all_stages) {
    const auto ran = [&](const FrameRecord& frame) { return frame.times.ran(stage); };
    if (std::any_of(result.frames.begin(), result.frames.end(), ran)) stages.push_back(stage);
  }
  return stages;
}

}  // namespace

std::string formatFrameTable(const RunResult& result) {
  const std::vector<Stage> stages = stagesOf(result);
  std::string text = "index,time_s,state,reason";
  for (const char* pose : {"live", "final"}) {
    for (const char* value : {"x", "y", "z", "qx", "qy", "qz", "qw"}) text += std::string(",") + pose + "_" + value;
  }
  text += ",sigma_x,sigma_y,sigma_z,sigma_rx_rad,sigma_ry_rad,sigma_rz_rad,tracked_points,mapped_points,keyframe";
  for (const Stage stage : stages) text += std::string(",") + stageName(stage) + "_ms";
  text += "\n";
  for (const FrameRecord& frame : result.frames) {
    text += std::to_string(frame.index) + "," + secondsWithNanoseconds(frame.time_ns) + "," + stateName(frame.state) +
            "," + quoted(frame.reason);
    appendPose(text, frame.has_pose, frame.world_T_camera);
    appendPose(text, frame.has_final_pose, frame.final_world_T_camera);
    appendStandardDeviations(text, frame);
    text += "," + std::to_string(frame.tracked_points) + "," + std::to_string(frame.mapped_points) +
            (frame.is_keyframe ? ",1" : ",0");
    for (const Stage stage : stages) {
      text += "," + (frame.times.ran(stage) ? number("%.3f", frame.times[stage]) : std::string());
    }
    text += "\n";
  }
  return text;
}

std::string formatKeyframes(const RunResult& result) {
  return "# keyframe trajectory: camera to world, in map units\n" + formatTrajectory(keyframeTrajectory(result));
}

void writeRunFiles(const std::string& folder, const RunResult& result, const RunDescription& description,
                   const std::optional<Trajectory>& ground_truth) {
  const RunSummary summary = summarise(result, ground_truth);
  const std::string summary_text =
      summaryJson(summary, result, description).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  std::vector<FileContent> files{{"trajectory.txt", formatTrajectory(finalTrajectory(result))},
                                 {"trajectory_live.txt", formatTrajectory(liveTrajectory(result))},
                                 {"frames.csv", formatFrameTable(result)},
                                 {"keyframes.txt", formatKeyframes(result)},
                                 {"map.ply", formatPly(result.map_points)},
                                 {"summary.json", summary_text}};
  if (reportsAreBuiltIn()) files.push_back({"report.html", formatReport(result, summary, description, ground_truth)});
  writeFileSet(folder, files);
}

}  // namespace edgeslam
