// An opened V4L2 capture device, and how its troubles are told.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/v4l2/system_calls.h"

namespace edgeslam {

struct CaptureDevice {
  Device device;
  std::string path;         // as the user gave it
  std::string card;         // "HD Pro Webcam C920", as the driver names it
  std::string driver, bus;  // "uvcvideo", "usb-0000:00:14.0-1"
  bool multi_planar = false;

  std::uint32_t bufferType() const;  // V4L2_BUF_TYPE_...
};

struct V4l2Problem {
  std::string text;       // empty: none
  bool may_heal = false;  // trying again can help
};

// "Device or resource busy (another program uses the camera)": `error` is an errno, positive or negative.
std::string errorText(int error);
// True for what passes when the camera is plugged in again or another program lets go of it.
bool mayHeal(int error);

struct OpenedDevice {
  std::unique_ptr<CaptureDevice> device;  // empty where there is a problem
  V4l2Problem problem;
  bool is_other_device = false;  // it is there, but no camera: a camera's metadata, an encoder, a file
};

// Opens `path` and makes sure that it is a camera that streams. The problem's text begins with the path.
OpenedDevice openCaptureDevice(SystemCalls& system, const std::string& path);

}  // namespace edgeslam
