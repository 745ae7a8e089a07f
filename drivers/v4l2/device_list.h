// The cameras that the kernel knows, with the names that stay theirs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/v4l2/camera_controls.h"
#include "drivers/v4l2/offered_formats.h"
#include "drivers/v4l2/sensor_rows.h"
#include "drivers/v4l2/system_calls.h"

namespace edgeslam {

struct ListedCamera {
  std::string path;     // "/dev/video0", which may be another camera's after the next start
  std::string by_id;    // "/dev/v4l/by-id/...", the same wherever it is plugged in; empty where udev gives none
  std::string by_path;  // "/dev/v4l/by-path/...", the same for whatever is plugged in there
  std::string card, driver, bus;
  std::vector<OfferedFormat> formats;
  std::vector<CameraControl> controls;
  std::optional<SensorRows> sensor;  // in the present mode, where the driver tells
  std::string problem;               // why it tells nothing of itself (in use, no rights); empty otherwise

  // The name to put into a configuration: by its identity, else its place, else its number.
  const std::string& stableName() const { return !by_id.empty() ? by_id : !by_path.empty() ? by_path : path; }
};

// In the order of their numbers; devices that capture no video (a camera's metadata, encoders) are left out. `folder`
// is /dev, other than in tests.
std::vector<ListedCamera> listV4l2Cameras(const std::string& folder = "/dev", SystemCalls& system = kernel());

}  // namespace edgeslam
