// A V4L2 camera: frames streamed through mapped buffers, one copy from the driver's buffer to the caller's grey image.
#pragma once

#include "drivers/frame_capture/camera_options.h"
#include "drivers/frame_capture/live_camera.h"
#include "drivers/v4l2/system_calls.h"

namespace edgeslam {

// Opens, sets the controls, settles the format and starts the stream. `options.device` is a path under /dev; those in
// /dev/v4l/by-id and by-path name the same camera after it was plugged in again.
OpenedCamera openV4l2Camera(const CameraOptions& options, SystemCalls& system = kernel());

}  // namespace edgeslam
