// The robot's wheel odometry, as others publish it: bot_core.pose_t, of which the pose alone is used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/lcm/message_receiver.h"
#include "wheels/odometry_pose.h"

namespace edgeslam {

// None where the bytes are no pose_t, or the pose none that wheels can say (isUsable()), or its quaternion's norm is
// off 1 by over 0.01.
std::optional<OdometryPose> checkOdometry(const void* data, std::size_t bytes);

using OdometryReceiver = MessageReceiver<OdometryPose, 1024>;  // over 1 s at 1000 a second

}  // namespace edgeslam
