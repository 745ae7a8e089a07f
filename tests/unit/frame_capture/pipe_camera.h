// The driver that docs/camera_drivers.md shows, as it stands there: a named pipe into which another program writes grey
// frames, one after the other without anything between.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "drivers/frame_capture/camera_options.h"
#include "drivers/frame_capture/live_camera.h"

namespace edgeslam {

class PipeCamera : public LiveCamera {
 public:
  PipeCamera(int descriptor, const StreamDescription& stream) : descriptor_(descriptor), stream_(stream) {}
  ~PipeCamera() override { ::close(descriptor_); }
  PipeCamera(const PipeCamera&) = delete;
  PipeCamera& operator=(const PipeCamera&) = delete;

  Capture next(cv::Mat& grey, std::chrono::nanoseconds timeout) override {
    const Clock::time_point end = Clock::now() + timeout;
    partial_.create(stream_.height, stream_.width, CV_8U);
    while (filled_ < partial_.total()) {
      const auto left_ms = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
      pollfd wait{descriptor_, POLLIN, 0};
      if (left_ms <= 0 || ::poll(&wait, 1, static_cast<int>(left_ms)) == 0) return {};  // none yet
      const ssize_t got = ::read(descriptor_, partial_.data + filled_, partial_.total() - filled_);
      if (got == 0) return {CaptureEvent::interrupted, {}, stream_.camera + ": the other program closed it"};
      if (got < 0 && errno != EAGAIN && errno != EINTR) {
        return {CaptureEvent::interrupted, {}, stream_.camera + ": " + std::generic_category().message(errno)};
      }
      filled_ += got > 0 ? static_cast<std::size_t>(got) : 0;
    }
    filled_ = 0;
    partial_.copyTo(grey);
    Capture capture{CaptureEvent::frame, {}, ""};
    capture.frame.time_ns = std::chrono::nanoseconds(Clock::now().time_since_epoch()).count();
    capture.frame.time_meaning = TimeMeaning::arrival;  // the pipe does not tell when it was exposed
    capture.frame.sequence = sequence_++;
    return capture;
  }

  const StreamDescription& stream() const override { return stream_; }

 private:
  using Clock = std::chrono::steady_clock;  // CLOCK_MONOTONIC

  int descriptor_;
  StreamDescription stream_;
  cv::Mat partial_;
  std::size_t filled_ = 0;  // [bytes]
  std::int64_t sequence_ = 0;
};

inline OpenedCamera openPipeCamera(const CameraOptions& options) {
  const std::string path = options.device.substr(std::string("pipe:").size());
  if (options.width <= 0) return {nullptr, path + ": a pipe needs capture.width and capture.height", false};
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return {nullptr, path + ": cannot be opened: " + std::generic_category().message(errno), true};
  const std::string format = "GREY " + std::to_string(options.width) + " x " + std::to_string(options.height);
  const StreamDescription stream{path, format, options.width, options.height, 0, false};
  return {std::make_unique<PipeCamera>(descriptor, stream), "", false};
}

}  // namespace edgeslam
