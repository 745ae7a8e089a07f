#include "drivers/v4l2/v4l2_camera.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <optional>
#include <utility>

#include "drivers/frame_capture/exposure_middle.h"
#include "drivers/frame_capture/kept_jpeg.h"
#include "drivers/frame_capture/sequence_counter.h"
#include "drivers/v4l2/buffer_queue.h"
#include "drivers/v4l2/buffer_stamp.h"
#include "drivers/v4l2/camera_controls.h"
#include "drivers/v4l2/capture_device.h"
#include "drivers/v4l2/limited_exposure.h"
#include "drivers/v4l2/offered_formats.h"
#include "drivers/v4l2/sensor_rows.h"
#include "drivers/v4l2/stream_setup.h"

namespace edgeslam {
namespace {

Capture interrupted(const std::string& text) { return {CaptureEvent::interrupted, {}, text}; }

class V4l2Camera : public LiveCamera {
 public:
  V4l2Camera(std::unique_ptr<CaptureDevice> device, const StreamSetup& setup, const CameraOptions& options)
      : device_(std::move(device)),
        queue_(*device_),
        layout_(setup.layout),
        every_frame_(options.every_frame),
        readout_s_(options.readout_s) {
    stream_.camera = device_->path + " (" + device_->card + ")";
    stream_.width = layout_.width;
    stream_.height = layout_.height;
    stream_.format = std::string(pixelFormatName(layout_.format)) + " " + std::to_string(layout_.width) + " x " +
                     std::to_string(layout_.height);
    if (setup.frame_rate > 0) {
      stream_.format += ", " + rateText(setup.frame_rate) + " frames/s";
      stream_.frame_interval_ns = std::llround(1e9 / setup.frame_rate);
    }
    stream_.readout_s = readoutOfImages(*device_, setup);
    exposure_ns_ = fixedExposure(*device_);
  }

  V4l2Problem start(int buffers) { return queue_.start(buffers); }

  void limitExposure(const std::vector<CameraControl>& controls, double longest_ms) {
    keepFrameRate(*device_);
    limited_exposure_ = LimitedExposure::take(*device_, controls, longest_ms);
    if (limited_exposure_) exposure_ns_ = limited_exposure_->exposure_ns();
    stream_.format += limited_exposure_ ? ", exposure up to " + rateText(longest_ms) + " ms"
                                        : ", exposure without limit (the driver has none to set)";
  }

  Capture next(cv::Mat& grey, std::chrono::nanoseconds timeout) override {
    FilledBuffer buffer;
    if (const int error = waitForBuffer(buffer, timeout.count()); error < 0) {
      return error == -EAGAIN ? Capture{} : interrupted(stream_.camera + ": the stream broke: " + errorText(error));
    }
    CapturedFrame frame = numbered(buffer);
    while (!every_frame_) {
      FilledBuffer newer;
      if (queue_.take(newer) < 0) break;
      queue_.give(std::exchange(buffer, newer).index);  // a failure shows at the next call
      const std::int64_t lost = frame.lost_before, passed_over = frame.passed_over_before + 1;
      frame = numbered(buffer);
      frame.lost_before += lost;
      frame.passed_over_before = passed_over;
    }
    return finish(buffer, frame, grey);
  }

  const StreamDescription& stream() const override { return stream_; }
  void keepJpeg(bool keep) override { kept_jpeg_.keep(keep); }

 private:
  // 0, -EAGAIN where the time is up, or the negative errno that ends the stream.
  int waitForBuffer(FilledBuffer& buffer, std::int64_t timeout_ns) {
    SystemCalls& system = device_->device.system();
    const std::int64_t end_ns = system.now_ns() + std::max<std::int64_t>(timeout_ns, 0);
    while (true) {
      const std::int64_t left_ns = std::clamp<std::int64_t>(end_ns - system.now_ns(), 0, 1'000'000'000'000);
      pollfd poll{device_->device.descriptor(), POLLIN, 0};
      const int ready = system.wait(&poll, static_cast<int>((left_ns + 999'999) / 1'000'000));
      if (ready < 0 && ready != -EINTR) return ready;
      if (ready > 0) {
        const int error = queue_.take(buffer);
        if (error != -EAGAIN) return error;
        // Nothing to take, though poll answered: an error of the stream, which would make poll answer at once for ever.
        if ((poll.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) return (poll.revents & POLLHUP) != 0 ? -ENODEV : -EIO;
      }
      if (system.now_ns() >= end_ns) return -EAGAIN;
    }
  }

  CapturedFrame numbered(const FilledBuffer& buffer) {
    const SequenceCounter::Numbered number = counter_.add(buffer.sequence);
    CapturedFrame frame;
    frame.sequence = number.sequence;
    frame.lost_before = number.lost_before;
    return frame;
  }

  Capture finish(const FilledBuffer& buffer, CapturedFrame frame, cv::Mat& grey) {
    const std::int64_t arrival_ns = device_->device.system().now_ns();
    const std::optional<DriverStamp> stamp = stampOfBuffer(buffer.flags, buffer.stamp_s, buffer.stamp_us);
    const FrameTime time = middleOfExposure(stamp, exposure_ns_, readout_s_, arrival_ns);
    frame.time_ns = time.time_ns;
    frame.time_meaning = time.meaning;
    std::string damage;
    CameraJpeg jpeg;
    if ((buffer.flags & V4L2_BUF_FLAG_ERROR) != 0) {
      damage = "the driver marks it as broken";
    } else {
      damage = convertToGrey(layout_, buffer.data, buffer.size, jpeg_, grey);
      if (damage.empty()) jpeg = kept_jpeg_.of(layout_.format, buffer.data, buffer.size);
    }
    if (damage.empty() && limited_exposure_) {
      limited_exposure_->see(*device_, grey);
      exposure_ns_ = limited_exposure_->exposure_ns();
    }
    if (const int error = queue_.give(buffer.index); error < 0) {
      return interrupted(stream_.camera + ": does not take its buffer back: " + errorText(error));
    }
    if (damage.empty()) return {CaptureEvent::frame, frame, "", jpeg};
    return {CaptureEvent::damaged_frame, frame, "frame " + std::to_string(frame.sequence) + ": " + damage};
  }

  std::unique_ptr<CaptureDevice> device_;
  BufferQueue queue_;
  BufferLayout layout_;
  StreamDescription stream_;
  bool every_frame_;
  double readout_s_;              // of the calibration
  std::int64_t exposure_ns_ = 0;  // where it is set by hand or by us
  std::optional<LimitedExposure> limited_exposure_;
  SequenceCounter counter_;
  JpegDecoder jpeg_;
  KeptJpeg kept_jpeg_;
};

OpenedCamera problem(const V4l2Problem& what) { return {nullptr, what.text, what.may_heal}; }

}  // namespace

OpenedCamera openV4l2Camera(const CameraOptions& options, SystemCalls& system) {
  OpenedDevice opened = openCaptureDevice(system, options.device);
  if (!opened.device) return problem(opened.problem);
  const CaptureDevice& device = *opened.device;
  const SettledStream settled = settleStream(device, options);
  if (!settled.problem.text.empty()) return problem(settled.problem);
  const std::vector<CameraControl> controls = cameraControls(device);
  for (const ControlSetting& setting : options.controls) {
    if (const V4l2Problem failed = setControl(device, controls, setting); !failed.text.empty()) return problem(failed);
  }
  auto camera = std::make_unique<V4l2Camera>(std::move(opened.device), settled.setup, options);
  const bool by_hand = std::any_of(options.controls.begin(), options.controls.end(), [](const auto& setting) {
    return setting.name == "exposure" && setting.value != "auto";
  });
  if (options.longest_exposure_ms > 0 && !by_hand) camera->limitExposure(controls, options.longest_exposure_ms);
  if (const V4l2Problem failed = camera->start(options.buffers); !failed.text.empty()) return problem(failed);
  return {std::move(camera), "", false};
}

}  // namespace edgeslam
