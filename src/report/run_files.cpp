#include "report/run_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "edgeslam/input_error.h"
#include "files/file_set.h"
#include "files/format_text.h"
#include "report/ply.h"
#include "report/report.h"
#include "report/run_summary.h"

namespace edgeslam {
namespace {

struct WorldFileName {
  const char* stem;
  const char* before_number;
  const char* ending;
};

constexpr WorldFileName trajectory_name{"trajectory", "_map", ".txt"}, live_name{"trajectory_live", "_map", ".txt"},
    keyframes_name{"keyframes", "_map", ".txt"}, map_name{"map", "", ".ply"};

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

void appendWorld(std::string& row, bool has_pose, int world) {
  row += "," + (has_pose && world >= 0 ? std::to_string(world) : std::string());
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

// "trajectory.txt" of the main world, "trajectory_map1.txt" of the first of the others; "map.ply", "map1.ply".
std::string nameOfWorld(const WorldFileName& name, std::size_t number) {
  return name.stem + (number == 0 ? "" : name.before_number + std::to_string(number)) + name.ending;
}

// What depends on the poses and the map alone.
std::vector<FileContent> worldFiles(const RunResult& result, const std::vector<WorldSummary>& worlds) {
  std::vector<FileContent> files;
  for (std::size_t number = 0; number < worlds.size(); ++number) {
    const int world = worlds[number].world;
    files.push_back({nameOfWorld(trajectory_name, number), formatTrajectory(finalTrajectory(result, world))});
    files.push_back({nameOfWorld(live_name, number), formatTrajectory(liveTrajectory(result, world))});
    files.push_back({nameOfWorld(keyframes_name, number), formatKeyframes(result, world)});
    files.push_back({nameOfWorld(map_name, number), formatPly(mapPointsOf(result, world), mapLinesOf(result, world))});
  }
  std::size_t number = worlds.size();
  for (const int world : formerWorlds(result, worlds)) {
    files.push_back({nameOfWorld(live_name, number++), formatTrajectory(liveTrajectory(result, world))});
  }
  return files;
}

Trajectory odometryTrajectory(const RunResult& result) {
  Trajectory trajectory;
  for (const FrameRecord& frame : result.frames) {
    if (frame.has_odometry) trajectory.push_back({frame.time_ns, frame.odom_T_camera});
  }
  return trajectory;
}

void removeWorldsOfEarlierRuns(const std::string& folder, const std::vector<FileContent>& written) {
  namespace fs = std::filesystem;
  std::vector<fs::path> left_over;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.empty() ? "." : folder)) {
    const std::string name = entry.path().filename().string();
    const auto has_that_name = [&name](const FileContent& file) { return file.name == name; };
    if (!entry.is_regular_file() || !isFileOfAnotherWorld(name)) continue;
    if (std::none_of(written.begin(), written.end(), has_that_name)) left_over.push_back(entry.path());
  }
  for (const fs::path& path : left_over) {
    std::error_code error;
    if (!fs::remove(path, error) && error) {
      throw InputError(path.string() + ": is of an earlier run and cannot be removed: " + error.message());
    }
  }
}

}  // namespace

std::string formatFrameTable(const RunResult& result) {
  const std::vector<Stage> stages = stagesOf(result);
  std::string text = "index,time_s,state,reason";
  for (const char* pose : {"live", "final"}) {
    for (const char* value : {"world", "x", "y", "z", "qx", "qy", "qz", "qw"}) {
      text += std::string(",") + pose + "_" + value;
    }
  }
  text += ",sigma_x,sigma_y,sigma_z,sigma_rx_rad,sigma_ry_rad,sigma_rz_rad";
  text += ",tracked_points,mapped_points,noise_factor,keyframe";
  for (const Stage stage : stages) text += std::string(",") + stageName(stage) + "_ms";
  text += "\n";
  for (const FrameRecord& frame : result.frames) {
    text += std::to_string(frame.index) + "," + secondsWithNanoseconds(frame.time_ns) + "," + stateName(frame.state) +
            "," + quoted(frame.reason);
    appendWorld(text, frame.has_pose, frame.world);
    appendPose(text, frame.has_pose, frame.world_T_camera);
    appendWorld(text, frame.has_final_pose, frame.final_world);
    appendPose(text, frame.has_final_pose, frame.final_world_T_camera);
    appendStandardDeviations(text, frame);
    text += "," + std::to_string(frame.tracked_points) + "," + std::to_string(frame.mapped_points) + "," +
            number("%.3g", frame.noise_factor) + (frame.is_keyframe ? ",1" : ",0");
    for (const Stage stage : stages) {
      text += "," + (frame.times.ran(stage) ? number("%.3f", frame.times[stage]) : std::string());
    }
    text += "\n";
  }
  return text;
}

std::string formatKeyframes(const RunResult& result, int world) {
  return "# keyframe trajectory: camera to world, in map units\n" + formatTrajectory(keyframeTrajectory(result, world));
}

bool isFileOfAnotherWorld(const std::string& file) {
  for (const WorldFileName& name : {trajectory_name, live_name, keyframes_name, map_name}) {
    const std::string begin = std::string(name.stem) + name.before_number, end = name.ending;
    if (file.size() <= begin.size() + end.size() || file.compare(0, begin.size(), begin) != 0) continue;
    if (file.compare(file.size() - end.size(), end.size(), end) != 0) continue;
    const std::string number = file.substr(begin.size(), file.size() - begin.size() - end.size());
    if (number.front() != '0' && number.find_first_not_of("0123456789") == std::string::npos) return true;
  }
  return false;
}

void writeRunFiles(const std::string& folder, const RunResult& result, const RunDescription& description,
                   const std::optional<Trajectory>& ground_truth) {
  const RunSummary summary = summarise(result, ground_truth);
  const std::string summary_text =
      summaryJson(summary, result, description).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  std::vector<FileContent> files = worldFiles(result, summary.worlds);
  files.push_back({"trajectory_odometry.txt", formatTrajectory(odometryTrajectory(result))});
  files.push_back({"frames.csv", formatFrameTable(result)});
  files.push_back({"summary.json", summary_text});
  if (reportsAreBuiltIn()) files.push_back({"report.html", formatReport(result, summary, description, ground_truth)});
  writeFileSet(folder, files);
  removeWorldsOfEarlierRuns(folder, files);
}

}  // namespace edgeslam
