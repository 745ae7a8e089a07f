// A camera as the rest of the program sees it, whichever driver stands behind it: frames in grey with the time of their
// exposure, and every trouble as a value. One thread uses a camera at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "image_formats/jpeg_decoder.h"

namespace edgeslam {

// What a frame's time stamp is the time of, for messages: the best that the driver tells.
enum class TimeMeaning { exposure_middle, exposure_start, exposure_end, arrival };

struct CapturedFrame {
  std::int64_t time_ns = 0;  // CLOCK_MONOTONIC (a recording's own clock for recordings); grows from frame to frame
  TimeMeaning time_meaning = TimeMeaning::arrival;
  std::int64_t sequence = 0;            // over all frames of the camera from 0, lost ones included
  std::int64_t lost_before = 0;         // frames that the driver says it lost since the one before
  std::int64_t passed_over_before = 0;  // frames left out because a newer one was there already
  bool after_interruption = false;      // the first one since the camera was opened again
};

enum class CaptureEvent {
  frame,          // `frame` and the image are filled in
  none_yet,       // the time was up before a frame came
  damaged_frame,  // a frame came that cannot be used; `message` says why, the image is undefined
  interrupted,    // the stream broke; `message` says why and what a user can do
  ended           // a recording is at its end; a camera has none
};

struct Capture {
  CaptureEvent event = CaptureEvent::none_yet;
  CapturedFrame frame;
  std::string message;
  CameraJpeg jpeg = nullptr;  // of a frame, where the camera sent one and it is kept (LiveCamera::keepJpeg)
};

struct StreamDescription {
  std::string camera;  // its name, for messages
  std::string format;  // "YUYV 640 x 480, 30 frames/s", for messages
  int width = 0;       // [px]
  int height = 0;
  std::int64_t frame_interval_ns = 0;  // 0 where it is not known
  bool is_recording = false;           // whose pauses and damages are its own, and no reason to open it again
  double readout_s = 0;                // from the first row to the last, by the driver; 0: it does not tell
};

class LiveCamera {
 public:
  virtual ~LiveCamera() = default;
  // Waits for the next frame, at most `timeout`, and writes it to `grey` (CV_8U of the stream's size; made so where it
  // is not). After `interrupted` the camera must be opened anew.
  virtual Capture next(cv::Mat& grey, std::chrono::nanoseconds timeout) = 0;
  virtual const StreamDescription& stream() const = 0;
  // Whether frames that come as motion-JPEG are from now on given as they came, too. Until then they are not.
  virtual void keepJpeg(bool /*keep*/) {}
};

struct OpenedCamera {
  std::unique_ptr<LiveCamera> camera;  // streaming; empty where there is a problem
  std::string problem;                 // for people: the device, what is wrong, what is allowed
  bool may_heal = false;               // trying again can help: unplugged, in use by another program
};

// Opens the camera with the options that it was made with. May take as long as the driver does.
using CameraOpener = std::function<OpenedCamera()>;

}  // namespace edgeslam
