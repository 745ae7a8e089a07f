// The sensor behind a video device, by the media controller: a sub-device with controls of its own.
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/v4l2/capture_device.h"

namespace edgeslam {

struct SensorDevice {
  Device device;
  std::uint32_t pad = 0;  // that its images leave by
};

// Nothing where the video device has no media controller, where not exactly one sensor is linked to it, or where the
// sensor has no device of its own (USB cameras).
std::optional<SensorDevice> openSensor(const CaptureDevice& device);

}  // namespace edgeslam
