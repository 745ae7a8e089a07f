// Replay at the pace of the time stamps by the live schedule, as on the robot, and its recording.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "frames/frame_source.h"
#include "inertia/inertial_unit.h"
#include "map/map.h"
#include "pipeline/run_result.h"
#include "pipeline/settings.h"
#include "recording/recording_writer.h"
#include "tracking/frame_result.h"
#include "wheels/odometry_pose.h"

namespace edgeslam {

class RunPublisher;

struct LiveReplay {
  std::optional<Map> map_in;
  // What was measured beside the frames; times ascend.
  std::vector<InertialSample> inertia;
  std::vector<OdometryPose> wheels;
  double pace = 1;                    // frames come so many times as fast as their time stamps say
  std::string record_folder;          // empty: not recorded
  RecordingDescription description;   // of the recording
  RunPublisher* publisher = nullptr;  // null: nothing is published
  std::function<bool()> is_to_end;    // asked before each frame; empty: after the last one only
  // Called for each frame, in order, by another thread.
  std::function<void(const FrameResult&, const std::string& problem)> progress;
};

struct LiveReplayResult {
  RunResult run;
  Map map;
  std::string recording;  // how recording went; empty where it was not asked for
};

// Throws InputError where the recording cannot be begun.
LiveReplayResult replayLive(FrameSource& source, const Camera& camera, const Settings& settings,
                            const LiveReplay& replay);

}  // namespace edgeslam
