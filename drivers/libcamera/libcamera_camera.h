// Cameras by libcamera: Raspberry Pi, rkisp1, i.MX8 and others whose sensors V4L2 alone does not set up. Versions 0.0.3
// and later. Without libcamera at build time these functions are there and say so.
#pragma once

#include <string>
#include <vector>

#include "drivers/frame_capture/camera_options.h"
#include "drivers/frame_capture/live_camera.h"

namespace edgeslam {

constexpr const char* libcamera_prefix = "libcamera:";  // of a camera's name as `device`

struct LibcameraFormat {
  std::string name;  // ours where it can be turned to grey, otherwise libcamera's
  bool known = false;
  std::vector<cv::Size> sizes;  // [px]
};

struct LibcameraControl {
  std::string name;     // libcamera's: "ExposureTime"
  std::string allowed;  // "[100..66666]", as libcamera writes it
};

struct ListedLibcamera {
  std::string name;   // to put behind the prefix; stays the same camera's
  std::string model;  // of the sensor; empty where it is not told
  std::vector<LibcameraFormat> formats;
  std::vector<LibcameraControl> controls;
  std::string problem;  // in use by another program
};

struct LibcameraListing {
  std::vector<ListedLibcamera> cameras;
  std::string version;  // of libcamera, "v0.0.3"; empty where it was left out of this program
  std::string problem;  // why nothing can be listed
};

LibcameraListing listLibcameras();

// One at a time in a program, as libcamera has it. Time stamps are the middle of the exposure where the driver tells
// its length, of the middle row where the options have the readout.
OpenedCamera openLibcameraCamera(const CameraOptions& options);

}  // namespace edgeslam
