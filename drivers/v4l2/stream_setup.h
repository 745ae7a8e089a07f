// Settles format, size, region and frame rate with the driver.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/frame_capture/camera_options.h"
#include "drivers/frame_capture/grey_conversion.h"
#include "drivers/v4l2/capture_device.h"

namespace edgeslam {

constexpr double rate_tolerance = 0.02;  // of frames: 29.97 a second are 30

struct StreamSetup {
  BufferLayout layout;
  double frame_rate = 0;  // [1/s]; 0 where the driver does not tell
};

struct SettledStream {
  StreamSetup setup;
  V4l2Problem problem;
};

// What the options leave open is chosen: the driver's present size; the frame rate fastest up to 30/s; of the formats
// that give it the one with the least work (pixel_formats). A driver that gives anything else than was asked for is a
// problem, whose text tells what it offers.
SettledStream settleStream(const CaptureDevice& device, const CameraOptions& options);

// The images' size as the driver has it now [px]; empty where it does not tell.
cv::Size presentSize(const CaptureDevice& device);

}  // namespace edgeslam
