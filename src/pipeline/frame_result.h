// What a frame came to, as it is given out at the time.
#pragma once

#include <string>

#include "map/keyframe.h"
#include "pipeline/run_result.h"
#include "tracking/stage_times.h"

namespace edgeslam {

struct FrameResult {
  std::int64_t index = 0;  // in the source
  std::int64_t time_ns = 0;
  TrackingState state = TrackingState::initialising;
  std::string reason;  // why it is not `tracking`, or empty
  bool has_pose = false;
  Pose world_T_camera;
  // Of the right-hand update [translation; rotation]: of the pose in the map as it is, and of the pose in the world, in
  // which the map itself may have drifted since its first keyframe.
  Matrix6d covariance = Matrix6d::Zero(), world_covariance = Matrix6d::Zero();
  KeyframeId reference = -1;  // the keyframe that carries this frame's final pose, or -1
  Pose reference_T_camera;
  int tracked_points = 0;
  int mapped_points = 0;
  StageTimes times;
  double latency_ms = 0;  // of a live run: from the frame's handing over by capture to its pose
};

}  // namespace edgeslam
