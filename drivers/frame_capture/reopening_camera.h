// A camera that comes back: when its stream breaks or freezes it is closed, and opened again with growing waits.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "drivers/frame_capture/live_camera.h"
#include "drivers/frame_capture/stream_watch.h"

namespace edgeslam {

struct CaptureClock {
  std::function<std::int64_t()> now_ns;        // CLOCK_MONOTONIC
  std::function<void(std::int64_t)> sleep_ns;  // at least as long
};

CaptureClock systemClock();

class ReopeningCamera : public LiveCamera {
 public:
  // `first`: the camera as `open` gave it, streaming. Another size after opening again is an error, told and tried
  // again.
  ReopeningCamera(CameraOpener open, std::unique_ptr<LiveCamera> first, const WatchPolicy& policy = {},
                  CaptureClock clock = systemClock());

  // A camera that is not there yet, and is waited for: its size, where it is not 0, and why it is not there.
  ReopeningCamera(CameraOpener open, const StreamDescription& expected, const std::string& problem,
                  const WatchPolicy& policy = {}, CaptureClock clock = systemClock());

  // As LiveCamera::next, but after `interrupted`, which comes once for each reason, just go on calling. Sequence
  // numbers go on over an interruption; a frame whose time stamp is not after the one before is damaged. Blocks longer
  // than `timeout` only where the driver does in opening.
  Capture next(cv::Mat& grey, std::chrono::nanoseconds timeout) override;
  const StreamDescription& stream() const override { return stream_; }
  void keepJpeg(bool keep) override;
  bool isOpen() const { return camera_ != nullptr; }

 private:
  Capture takeFrame(cv::Mat& grey, std::int64_t timeout_ns);
  Capture tryToOpen(std::int64_t timeout_ns);
  Capture interrupt(const std::string& why);
  std::string checkTimes(CapturedFrame& frame);

  CameraOpener open_;
  std::unique_ptr<LiveCamera> camera_;  // empty while it is closed
  StreamDescription stream_;
  StreamWatch watch_;
  CaptureClock clock_;
  std::string told_;    // the last reason that was told since the last frame
  std::string damage_;  // of the last damaged frame since the last good one
  bool after_interruption_ = false;
  bool keeps_jpeg_ = false;
  std::int64_t sequence_offset_ = 0;  // of the stream in all frames of the camera
  std::int64_t last_sequence_ = -1;
  std::int64_t last_time_ns_ = -1;
};

}  // namespace edgeslam
