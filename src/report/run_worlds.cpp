#include "report/run_worlds.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

namespace edgeslam {
namespace {

// A pose whose world is not told is in the first.
int worldOfPose(int world) { return std::max(0, world); }

}  // namespace

bool hasFinalPoseIn(const FrameRecord& frame, int world) {
  return frame.has_final_pose && worldOfPose(frame.final_world) == world;
}

bool hasGoodLivePoseIn(const FrameRecord& frame, int world) {
  return frame.has_pose && isGoodPose(frame.state) && worldOfPose(frame.world) == world;
}

std::vector<WorldSummary> worldsOf(const RunResult& result) {
  std::map<int, WorldSummary> worlds;
  worlds[result.main_world].world = result.main_world;
  for (const FrameRecord& frame : result.frames) {
    if (!frame.has_final_pose) continue;
    WorldSummary& world = worlds[worldOfPose(frame.final_world)];
    world.world = worldOfPose(frame.final_world);
    if (world.final_poses++ == 0) {
      world.first_pose_s = 1e-9 * static_cast<double>(frame.time_ns - result.frames.front().time_ns);
    }
  }
  const auto count = [&worlds](int world, std::int64_t WorldSummary::*figure) {
    const auto found = worlds.find(world);
    if (found != worlds.end()) ++(found->second.*figure);
  };
  for (const KeyframeRecord& keyframe : result.keyframes) count(keyframe.world, &WorldSummary::keyframes);
  for (const MapPointRecord& point : result.map_points) count(point.world, &WorldSummary::map_points);
  for (const MapLineRecord& line : result.map_lines) count(line.world, &WorldSummary::map_lines);

  std::vector<WorldSummary> summaries{worlds[result.main_world]};
  for (const auto& [world, summary] : worlds) {
    if (world != result.main_world) summaries.push_back(summary);
  }
  return summaries;
}

std::vector<int> formerWorlds(const RunResult& result, const std::vector<WorldSummary>& worlds) {
  std::set<int> former;
  for (const FrameRecord& frame : result.frames) {
    if (frame.has_pose && isGoodPose(frame.state)) former.insert(worldOfPose(frame.world));
  }
  for (const WorldSummary& world : worlds) former.erase(world.world);
  return {former.begin(), former.end()};
}

Trajectory finalTrajectory(const RunResult& result, int world) {
  Trajectory trajectory;
  for (const FrameRecord& frame : result.frames) {
    if (hasFinalPoseIn(frame, world)) trajectory.push_back({frame.time_ns, frame.final_world_T_camera});
  }
  return trajectory;
}

Trajectory liveTrajectory(const RunResult& result, int world) {
  Trajectory trajectory;
  for (const FrameRecord& frame : result.frames) {
    if (hasGoodLivePoseIn(frame, world)) trajectory.push_back({frame.time_ns, frame.world_T_camera});
  }
  return trajectory;
}

Trajectory keyframeTrajectory(const RunResult& result, int world) {
  Trajectory trajectory;
  for (const KeyframeRecord& keyframe : result.keyframes) {
    if (keyframe.world == world) trajectory.push_back({keyframe.time_ns, keyframe.world_T_camera});
  }
  return trajectory;
}

std::vector<MapPointRecord> mapPointsOf(const RunResult& result, int world) {
  std::vector<MapPointRecord> points;
  std::copy_if(result.map_points.begin(), result.map_points.end(), std::back_inserter(points),
               [world](const MapPointRecord& point) { return point.world == world; });
  return points;
}

std::vector<MapLineRecord> mapLinesOf(const RunResult& result, int world) {
  std::vector<MapLineRecord> lines;
  std::copy_if(result.map_lines.begin(), result.map_lines.end(), std::back_inserter(lines),
               [world](const MapLineRecord& line) { return line.world == world; });
  return lines;
}

std::string worldsInWords(const std::vector<WorldSummary>& worlds) {
  if (worlds.size() < 2) return "";
  std::int64_t in_others = 0;
  for (std::size_t i = 1; i < worlds.size(); ++i) in_others += worlds[i].final_poses;
  return std::to_string(worlds.size()) + " maps that were not joined: " + std::to_string(worlds[0].final_poses) +
         " frames in the main one, " + std::to_string(in_others) + " in others";
}

}  // namespace edgeslam
