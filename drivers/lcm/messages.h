// A frame's result as LCM messages; frames and units are in the comments of types/*.lcm. Every number is finite.
#pragma once

#include <optional>
#include <string>

#include "drivers/lcm/body_pose.h"
#include "edgeslam/pose_t.hpp"
#include "edgeslam/state_t.hpp"
#include "edgeslam/update_t.hpp"
#include "wheels/utime.h"

namespace edgeslam {

struct LcmFrame {
  state_t state;               // every frame
  std::optional<pose_t> pose;  // of a measured pose alone
  update_t update;             // every frame
};

// `before`: the latest measured pose of an earlier frame, if any. A pose that is not finite is told as lost.
// `publish_utime`: CLOCK_REALTIME [us].
LcmFrame frameMessages(const FrameResult& result, const RobotSetup& robot, const std::optional<MeasuredPose>& before,
                       std::int64_t sequence, std::int64_t publish_utime);

// state_t's numbers.
std::int8_t stateNumber(TrackingState state);
std::int8_t scaleNumber(ScaleKind kind);

// What strings in messages hold: printable ASCII, other bytes become '?', at most 200 characters.
std::string messageText(const std::string& text);

}  // namespace edgeslam
