// The camera that the options name, whichever driver it takes.
#pragma once

#include "drivers/frame_capture/camera_options.h"
#include "drivers/frame_capture/live_camera.h"
#include "drivers/frame_capture/reopening_camera.h"

namespace edgeslam {

// `device`: a path under /dev (V4L2), libcamera:NAME, or a folder or video (a recording, at the pace of its time
// stamps). A recording that cannot be used is a problem, too.
OpenedCamera openCamera(const CameraOptions& options);

// The same, as a camera that comes back after an interruption. Throws InputError where it cannot be opened now.
std::unique_ptr<ReopeningCamera> openLastingCamera(const CameraOptions& options);

// As openLastingCamera(), but a camera that is not there yet, or is in use, is waited for: `problem` then says what is
// the matter. `size`: that its frames must have [px]. Throws InputError where waiting cannot help, or frames have
// another size.
std::unique_ptr<ReopeningCamera> openOrAwaitCamera(const CameraOptions& options, cv::Size size, std::string& problem);

}  // namespace edgeslam
