// What the robot's inertial unit measured, as others publish it: edgeslam.imu_t, or bot_core.ins_t, of which rate and
// force alone are used.
#pragma once

#include <cstddef>
#include <optional>

#include "drivers/lcm/message_receiver.h"
#include "inertia/inertial_unit.h"

namespace edgeslam {

// None where the bytes are neither, or it is nothing that a unit can have measured (isUsable()), or its time stamp is
// negative or over 4e15 us.
std::optional<InertialSample> checkImu(const void* data, std::size_t bytes);

using ImuReceiver = MessageReceiver<InertialSample, 4096>;  // over 2 s at 2000 a second

}  // namespace edgeslam
