// A camera's controls (exposure, gain, ...) by name, with what is allowed told where the driver refuses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/frame_capture/camera_options.h"
#include "drivers/v4l2/capture_device.h"

namespace edgeslam {

struct ControlChoice {
  std::int64_t value = 0;
  std::string name;
};

struct CameraControl {
  std::uint32_t id = 0;
  std::string name;  // "exposure_time_absolute": lower case, runs of other characters than letters and digits as one _
  std::uint32_t type = 0;  // V4L2_CTRL_TYPE_...
  std::int64_t least = 0, largest = 0, step = 1, usual = 0;
  std::int64_t value = 0;
  bool has_value = false;  // can be read
  bool read_only = false;
  bool inactive = false;               // until another control allows it
  std::vector<ControlChoice> choices;  // of a menu
};

// Numbers, switches and menus, in the driver's order; others (texts, arrays, buttons) are left out.
std::vector<CameraControl> cameraControls(const CaptureDevice& device);

// Sets one control by a name that all drivers share or by the driver's own. The problem's text has the device, the
// name, the value, what the driver says and what is allowed.
V4l2Problem setControl(const CaptureDevice& device, const std::vector<CameraControl>& controls,
                       const ControlSetting& setting);

// "1 to 10000 in steps of 1", "0 (Disabled), 1 (50 Hz), 2 (60 Hz)", "true or false".
std::string allowedValues(const CameraControl& control);

// The exposure time where it is fixed by hand, so that it can be counted on; 0 otherwise [ns].
std::int64_t fixedExposure(const CaptureDevice& device);

// Keeps the automatic exposure from lengthening the frame interval, where the driver has a switch for it.
void keepFrameRate(const CaptureDevice& device);

}  // namespace edgeslam
