// What a user can ask of a camera (the configuration's `capture:` section).
#pragma once

#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

namespace edgeslam {

// By one of the names that all drivers share, or by the driver's own name as `edgeslam cameras` lists it:
//   exposure              [ms], or auto
//   gain                  in the driver's units, or auto
//   white_balance         [K], or auto
//   focus                 in the driver's units, or auto
//   power_line_frequency  50, 60 [Hz], off or auto
struct ControlSetting {
  std::string name, value;
};

struct CameraOptions {
  std::string device;              // /dev/video0, /dev/v4l/by-id/..., libcamera:NAME, or the path of a recording
  std::string format;              // "GREY", "YUYV", ... (pixel_format.h); empty: the one that serves best
  int width = 0;                   // [px]; 0: as the driver has it
  int height = 0;                  // [px]
  double frame_rate = 0;           // [1/s]; 0: the fastest up to 30
  cv::Rect region;                 // of the sensor that is read [px]; empty: all of it
  double longest_exposure_ms = 0;  // 0: as the driver has it
  std::vector<ControlSetting> controls;
  double readout_s = 0;      // of the calibration, for the time stamps; 0: a global shutter, or not known
  int buffers = 4;           // that the driver fills in turn
  bool every_frame = false;  // also those that a newer one has overtaken, for recording
};

}  // namespace edgeslam
