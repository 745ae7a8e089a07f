// Settings by name and text to libcamera's controls. By their names at run time, as the set of controls differs from
// version to version and from camera to camera.
#pragma once

#include <libcamera/controls.h>

#include <string>

#include "drivers/frame_capture/camera_options.h"

namespace edgeslam {

// Adds what all of `options` ask for (controls, frame rate, region, longest exposure) to `list`. Returns what is wrong,
// with the setting and what the camera allows, or an empty text.
std::string addControls(const CameraOptions& options, const libcamera::ControlInfoMap& offered,
                        libcamera::ControlList& list);

}  // namespace edgeslam
