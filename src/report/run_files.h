// The files that a run leaves: trajectories, a table of frames, keyframes, the map, a summary and a report to look at.
// Where maps were not joined (run_worlds.h), each has its own trajectories, keyframes and map.
#pragma once

#include <optional>
#include <string>

#include "evaluation/trajectory.h"
#include "pipeline/run_result.h"
#include "report/run_description.h"

namespace edgeslam {

// frames.csv: a heading and a line a frame: index, time [s], state, reason, live pose, final pose (each with its world;
// map units, camera to world), standard deviations of the live pose (map units, rad), points, noise factor, whether a
// keyframe, time of each stage [ms].
// What a frame doesn't have is an empty field. Text is quoted where RFC 4180 asks it.
std::string formatFrameTable(const RunResult& result);

// keyframes.txt of a world: TUM format below a comment that says what it is.
std::string formatKeyframes(const RunResult& result, int world);

// Writes trajectory.txt, trajectory_live.txt, trajectory_odometry.txt, frames.csv, keyframes.txt, map.ply, summary.json
// and report.html into `folder`, which is made if need be and whose files of these names are replaced. Trajectories,
// keyframes and map are those of the main world; the others' are trajectory_map1.txt, trajectory_live_map1.txt,
// keyframes_map1.txt, map1.ply and so on, ascending by world. A world that has live poses but no final ones, having
// been joined to another, has a live trajectory alone, numbered behind these. Files of other worlds of an earlier run
// are removed. All are complete before the first is put in its place; where one cannot be written (no permission, full
// disk) throws InputError and leaves none of the new ones. The trajectories, keyframes.txt and map.ply depend on the
// poses and the map alone: equal results give equal bytes.
void writeRunFiles(const std::string& folder, const RunResult& result, const RunDescription& description,
                   const std::optional<Trajectory>& ground_truth);

// True of the name of a file that writeRunFiles makes for another world than the main one.
bool isFileOfAnotherWorld(const std::string& name);

}  // namespace edgeslam
