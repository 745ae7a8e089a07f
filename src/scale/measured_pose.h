// A frame's measured pose, as motion from it to the next one is told: on the messages, and against the wheels.
#pragma once

#include <cstdint>
#include <optional>

#include "tracking/frame_result.h"

namespace edgeslam {

struct MeasuredPose {
  std::int64_t time_ns = 0;
  int world = 0;               // that the pose is in: poses of two worlds do not go together
  Pose world_T_camera;         // map units
  KeyframeId reference = -1;   // -1: none
  Pose reference_T_camera;     // map units
  Matrix6d covariance_camera;  // right-hand update [translation; rotation], map units and rad
};

// A finite pose with a quaternion that can be normalized.
bool hasUsablePose(const FrameResult& result);

// That the pose is in, from 0; -1 where there is no usable pose.
int worldOf(const FrameResult& result);

// None where the pose was not measured, or its position was held, or it cannot be used.
std::optional<MeasuredPose> measuredPose(const FrameResult& result);

// before_T_now [map units], of two poses in one world: through the keyframe that both hang on, where there is one.
Pose cameraMotion(const MeasuredPose& before, const MeasuredPose& now);

}  // namespace edgeslam
