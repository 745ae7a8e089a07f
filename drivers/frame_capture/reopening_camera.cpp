#include "drivers/frame_capture/reopening_camera.h"

#include <algorithm>
#include <utility>

namespace edgeslam {

CaptureClock systemClock() {
  return {
      [] {
        return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
            .count();
      },
      [](std::int64_t duration_ns) {
        timespec duration{};
        duration.tv_sec = duration_ns / 1'000'000'000;
        duration.tv_nsec = duration_ns % 1'000'000'000;
        nanosleep(&duration, nullptr);
      }};
}

ReopeningCamera::ReopeningCamera(CameraOpener open, std::unique_ptr<LiveCamera> first, const WatchPolicy& policy,
                                 CaptureClock clock)
    : open_(std::move(open)),
      camera_(std::move(first)),
      stream_(camera_->stream()),
      watch_(policy),
      clock_(std::move(clock)) {
  watch_.opened(clock_.now_ns(), stream_.frame_interval_ns);
}

ReopeningCamera::ReopeningCamera(CameraOpener open, const StreamDescription& expected, const std::string& problem,
                                 const WatchPolicy& policy, CaptureClock clock)
    : open_(std::move(open)), stream_(expected), watch_(policy), clock_(std::move(clock)), told_(problem) {
  watch_.failed(clock_.now_ns());
}

Capture ReopeningCamera::next(cv::Mat& grey, std::chrono::nanoseconds timeout) {
  return camera_ ? takeFrame(grey, timeout.count()) : tryToOpen(timeout.count());
}

void ReopeningCamera::keepJpeg(bool keep) {
  keeps_jpeg_ = keep;
  if (camera_) camera_->keepJpeg(keep);
}

Capture ReopeningCamera::takeFrame(cv::Mat& grey, std::int64_t timeout_ns) {
  const std::int64_t left_ns =
      stream_.is_recording ? timeout_ns : std::max<std::int64_t>(watch_.frozenAt() - clock_.now_ns(), 0);
  Capture capture = camera_->next(grey, std::chrono::nanoseconds(std::min(timeout_ns, left_ns)));
  if (capture.event == CaptureEvent::interrupted) return interrupt(capture.message);
  if (capture.event == CaptureEvent::ended) return capture;

  const std::int64_t now_ns = clock_.now_ns();
  if (capture.event == CaptureEvent::frame) {
    capture.message = checkTimes(capture.frame);
    if (!capture.message.empty()) capture.event = CaptureEvent::damaged_frame;
  }
  if (capture.event == CaptureEvent::frame) {
    watch_.gotFrame(now_ns);
    told_.clear();
    damage_.clear();
    return capture;
  }
  if (capture.event == CaptureEvent::damaged_frame) {
    watch_.gotDamagedFrame(now_ns);
    damage_ = capture.message;
  }
  if (stream_.is_recording || now_ns < watch_.frozenAt()) return capture;
  return interrupt(stream_.camera + (damage_.empty() ? ": the stream is frozen, no frame came in time"
                                                     : ": only damaged frames came: " + damage_));
}

// Fills in the place of the frame among all of the camera's. Empty, or what is wrong with its time stamp.
std::string ReopeningCamera::checkTimes(CapturedFrame& frame) {
  frame.sequence += sequence_offset_;
  last_sequence_ = std::max(last_sequence_, frame.sequence);
  if (frame.time_ns <= last_time_ns_) return "its time stamp is not after that of the frame before";
  last_time_ns_ = frame.time_ns;
  frame.after_interruption = std::exchange(after_interruption_, false);
  return "";
}

Capture ReopeningCamera::interrupt(const std::string& why) {
  camera_.reset();  // a driver may need to be closed before it can be opened again
  watch_.failed(clock_.now_ns());
  if (why == told_) return {};
  told_ = why;
  return {CaptureEvent::interrupted, {}, why};
}

Capture ReopeningCamera::tryToOpen(std::int64_t timeout_ns) {
  const std::int64_t wait_ns = watch_.tryAt() - clock_.now_ns();
  if (wait_ns > 0) clock_.sleep_ns(std::min(wait_ns, timeout_ns));
  if (wait_ns > timeout_ns) return {};

  OpenedCamera opened = open_();
  if (!opened.camera) return interrupt(opened.problem);
  const StreamDescription& stream = opened.camera->stream();
  if (stream_.width > 0 && (stream.width != stream_.width || stream.height != stream_.height)) {
    return interrupt(stream.camera + ": gives another size, " + stream.format + "; expected are " +
                     std::to_string(stream_.width) + " x " + std::to_string(stream_.height));
  }
  camera_ = std::move(opened.camera);
  camera_->keepJpeg(keeps_jpeg_);
  stream_ = camera_->stream();
  watch_.opened(clock_.now_ns(), stream_.frame_interval_ns);
  sequence_offset_ = last_sequence_ + 1;
  after_interruption_ = true;
  damage_.clear();
  return {};
}

}  // namespace edgeslam
