#include "drivers/libcamera/libcamera_camera.h"

#include <libcamera/camera.h>
#include <libcamera/control_ids.h>
#include <libcamera/framebuffer_allocator.h>
#include <libcamera/request.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cmath>
#include <memory>
#include <system_error>
#include <utility>

#include "drivers/frame_capture/exposure_middle.h"
#include "drivers/frame_capture/grey_conversion.h"
#include "drivers/frame_capture/kept_jpeg.h"
#include "drivers/frame_capture/sequence_counter.h"
#include "drivers/libcamera/control_values.h"
#include "drivers/libcamera/frame_memory.h"
#include "drivers/libcamera/manager.h"

namespace edgeslam {
namespace {

std::int64_t clock_ns(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

std::string errorText(int error) {
  std::string text = std::generic_category().message(std::abs(error));
  if (std::abs(error) == EBUSY) text += " (another program uses the camera)";
  return text;
}

class LibcameraCamera : public LiveCamera {
 public:
  explicit LibcameraCamera(const CameraOptions& options) : options_(options) {}

  // libcamera wants all of a camera given back before its manager stops.
  ~LibcameraCamera() override {
    if (camera_ && acquired_) {
      if (started_) camera_->stop();
      camera_->requestCompleted.disconnect(this);
      camera_->disconnected.disconnect(this);
      requests_.clear();
      allocator_.reset();
      configuration_.reset();
      camera_->release();
    }
    camera_.reset();
    if (wake_ >= 0) close(wake_);
  }
  LibcameraCamera(const LibcameraCamera&) = delete;
  LibcameraCamera& operator=(const LibcameraCamera&) = delete;

  struct Problem {
    std::string text;
    bool may_heal = false;
  };

  Problem open() {
    if (!manager_.problem().empty()) return {manager_.problem(), true};
    if (Problem failed = acquire(); !failed.text.empty()) return failed;
    if (Problem failed = configure(); !failed.text.empty()) return failed;
    if (Problem failed = allocate(); !failed.text.empty()) return failed;
    return start();
  }

  Capture next(cv::Mat& grey, std::chrono::nanoseconds timeout) override {
    libcamera::Request* request = waitForRequest(timeout.count());
    if (unplugged_) return {CaptureEvent::interrupted, {}, stream_.camera + ": the camera is not plugged in any more"};
    if (request == nullptr) return {};
    CapturedFrame frame = numbered(*request);
    libcamera::Request* newer = nullptr;
    while (!options_.every_frame && completed_.pop(newer)) {
      const std::int64_t lost = frame.lost_before, passed_over = frame.passed_over_before + 1;
      giveBack(*std::exchange(request, newer));
      frame = numbered(*request);
      frame.lost_before += lost;
      frame.passed_over_before = passed_over;
    }
    CameraJpeg jpeg;
    const std::string damage = readFrame(*request, frame, grey, jpeg);
    if (const int error = giveBack(*request); error < 0) {
      return {CaptureEvent::interrupted, {}, stream_.camera + ": takes no more requests: " + errorText(error)};
    }
    if (damage.empty()) return {CaptureEvent::frame, frame, "", jpeg};
    return {CaptureEvent::damaged_frame, frame, "frame " + std::to_string(frame.sequence) + ": " + damage};
  }

  const StreamDescription& stream() const override { return stream_; }
  void keepJpeg(bool keep) override { kept_jpeg_.keep(keep); }

 private:
  Problem acquire() {
    const std::string name = options_.device.substr(std::string(libcamera_prefix).size());
    camera_ = manager_->get(name);
    if (!camera_) {
      std::string names;
      for (const auto& camera : manager_->cameras()) names += (names.empty() ? "" : ", ") + camera->id();
      return {"there is no such camera; libcamera sees " + (names.empty() ? "none" : names), true};
    }
    stream_.camera = options_.device;
    if (const int error = camera_->acquire(); error < 0) return {"cannot be taken: " + errorText(error), true};
    acquired_ = true;
    return {};
  }

  Problem configure() {
    configuration_ = camera_->generateConfiguration({libcamera::StreamRole::VideoRecording});
    if (!configuration_ || configuration_->empty()) return {"gives no video", false};
    libcamera::StreamConfiguration& stream = configuration_->at(0);
    const std::vector<libcamera::PixelFormat> offered = stream.formats().pixelformats();
    std::string names;
    std::optional<PixelFormat> format;
    for (const PixelFormat known : pixel_formats) {
      if (std::find(offered.begin(), offered.end(), libcameraFormat(known)) == offered.end()) continue;
      names += (names.empty() ? "" : ", ") + std::string(pixelFormatName(known));
      if (!format && (options_.format.empty() || options_.format == pixelFormatName(known))) format = known;
    }
    if (!format) {
      return {"has no format " + (options_.format.empty() ? "that is known here" : options_.format) + "; it offers " +
                  (names.empty() ? "none that is known here" : names),
              false};
    }
    stream.pixelFormat = libcameraFormat(*format);
    const bool sized = options_.width > 0 && options_.height > 0;
    if (sized) stream.size = {static_cast<unsigned int>(options_.width), static_cast<unsigned int>(options_.height)};
    stream.bufferCount = static_cast<unsigned int>(std::clamp(options_.buffers, 2, 32));
    const libcamera::Size wanted = stream.size;
    if (configuration_->validate() == libcamera::CameraConfiguration::Invalid) {
      return {"refuses " + wanted.toString() + " " + pixelFormatName(*format), false};
    }
    if (stream.pixelFormat != libcameraFormat(*format) || (sized && stream.size != wanted)) {
      return {"refuses " + wanted.toString() + " " + pixelFormatName(*format) + ", it would give " + stream.toString(),
              false};
    }
    if (const int error = camera_->configure(configuration_.get()); error < 0) {
      return {"cannot be configured: " + errorText(error), true};
    }
    layout_ = {*format, static_cast<int>(stream.size.width), static_cast<int>(stream.size.height), stream.stride};
    stream_.width = layout_.width;
    stream_.height = layout_.height;
    stream_.format = std::string(pixelFormatName(*format)) + " " + std::to_string(layout_.width) + " x " +
                     std::to_string(layout_.height);
    if (options_.frame_rate > 0) stream_.frame_interval_ns = std::llround(1e9 / options_.frame_rate);
    return {};
  }

  Problem allocate() {
    libcamera::Stream* const stream = configuration_->at(0).stream();
    allocator_ = std::make_unique<libcamera::FrameBufferAllocator>(camera_);
    if (const int error = allocator_->allocate(stream); error < 0)
      return {"gives no buffers: " + errorText(error), true};
    const auto& buffers = allocator_->buffers(stream);
    if (std::string failed = memory_.map(buffers); !failed.empty()) return {failed, true};
    for (const std::unique_ptr<libcamera::FrameBuffer>& buffer : buffers) {
      std::unique_ptr<libcamera::Request> request = camera_->createRequest();
      if (!request || request->addBuffer(stream, buffer.get()) < 0) return {"takes no requests", true};
      requests_.push_back(std::move(request));
    }
    return {};
  }

  Problem start() {
    wake_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    if (wake_ < 0) return {"no event file: " + errorText(errno), true};
    libcamera::ControlList controls(camera_->controls());
    if (std::string wrong = addControls(options_, camera_->controls(), controls); !wrong.empty()) return {wrong, false};
    camera_->requestCompleted.connect(this, &LibcameraCamera::onCompleted);
    camera_->disconnected.connect(this, &LibcameraCamera::onDisconnected);
    if (const int error = camera_->start(&controls); error < 0) return {"does not start: " + errorText(error), true};
    started_ = true;
    for (const std::unique_ptr<libcamera::Request>& request : requests_) {
      if (const int error = camera_->queueRequest(request.get()); error < 0) {
        return {"takes no requests: " + errorText(error), true};
      }
    }
    return {};
  }

  // In libcamera's thread.
  void onCompleted(libcamera::Request* request) {
    if (request->status() == libcamera::Request::RequestCancelled) return;
    completed_.push(request);
    wake();
  }
  void onDisconnected() {
    unplugged_ = true;
    wake();
  }
  void wake() const {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(wake_, &one, sizeof one);  // full only while it is awake anyway
  }

  libcamera::Request* waitForRequest(std::int64_t timeout_ns) {
    const std::int64_t end_ns = clock_ns(CLOCK_MONOTONIC) + std::max<std::int64_t>(timeout_ns, 0);
    libcamera::Request* request = nullptr;
    while (!completed_.pop(request) && !unplugged_) {
      const std::int64_t left_ns = end_ns - clock_ns(CLOCK_MONOTONIC);
      if (left_ns <= 0) return nullptr;
      pollfd waiting{wake_, POLLIN, 0};
      poll(&waiting, 1, static_cast<int>(std::min<std::int64_t>((left_ns + 999'999) / 1'000'000, 1'000'000)));
      std::uint64_t count = 0;
      [[maybe_unused]] const ssize_t taken = read(wake_, &count, sizeof count);
    }
    return request;
  }

  // libcamera's "virtual" pipeline leaves the buffers' sequence numbers unset; requests are numbered by all, but tell
  // no loss.
  CapturedFrame numbered(const libcamera::Request& request) {
    const bool counts = camera_->id().rfind("Virtual", 0) != 0;
    const libcamera::FrameBuffer* const buffer = request.buffers().begin()->second;
    const SequenceCounter::Numbered number = counter_.add(counts ? buffer->metadata().sequence : request.sequence());
    CapturedFrame frame;
    frame.sequence = number.sequence;
    frame.lost_before = number.lost_before;
    return frame;
  }

  // Empty, or what is wrong with it.
  std::string readFrame(libcamera::Request& request, CapturedFrame& frame, cv::Mat& grey, CameraJpeg& jpeg) {
    const std::int64_t arrival_ns = clock_ns(CLOCK_MONOTONIC);
    const auto exposure_us = request.metadata().get(libcamera::controls::ExposureTime);
    std::optional<DriverStamp> stamp;
    if (const auto sensor_ns = request.metadata().get(libcamera::controls::SensorTimestamp)) {
      // Documented as of CLOCK_BOOTTIME, which is ahead of CLOCK_MONOTONIC by the time spent suspended; V4L2 drivers'
      // stamps, which most pipelines hand on, are of the latter.
      const std::int64_t suspended_ns = clock_ns(CLOCK_BOOTTIME) - arrival_ns;
      const bool is_boot_time = *sensor_ns > arrival_ns + furthest_ahead_ns;
      stamp = DriverStamp{*sensor_ns - (is_boot_time ? suspended_ns : 0), TimeMeaning::exposure_start};
    }
    const std::int64_t exposure_ns = exposure_us ? std::int64_t{*exposure_us} * 1000 : 0;
    const FrameTime time = middleOfExposure(stamp, exposure_ns, options_.readout_s, arrival_ns);
    frame.time_ns = time.time_ns;
    frame.time_meaning = time.meaning;

    const libcamera::FrameBuffer* const buffer = request.buffers().begin()->second;
    const libcamera::FrameMetadata& metadata = buffer->metadata();
    if (metadata.status == libcamera::FrameMetadata::FrameError) return "the driver marks it as broken";
    FrameMemory::Plane plane = memory_.firstPlane(buffer);
    // Only motion-JPEG's length differs from frame to frame.
    if (layout_.format == PixelFormat::mjpeg && !metadata.planes().empty()) {
      plane.size = std::min<std::size_t>(plane.size, metadata.planes()[0].bytesused);
    }
    std::string damage = convertToGrey(layout_, plane.data, plane.size, jpeg_, grey);
    if (damage.empty()) jpeg = kept_jpeg_.of(layout_.format, plane.data, plane.size);
    return damage;
  }

  int giveBack(libcamera::Request& request) {
    request.reuse(libcamera::Request::ReuseBuffers);
    return camera_->queueRequest(&request);
  }

  CameraOptions options_;
  StreamDescription stream_;
  BufferLayout layout_;
  Manager manager_;
  std::shared_ptr<libcamera::Camera> camera_;
  bool acquired_ = false, started_ = false;
  std::unique_ptr<libcamera::CameraConfiguration> configuration_;
  std::unique_ptr<libcamera::FrameBufferAllocator> allocator_;
  FrameMemory memory_;
  std::vector<std::unique_ptr<libcamera::Request>> requests_;
  boost::lockfree::spsc_queue<libcamera::Request*, boost::lockfree::capacity<64>> completed_;
  std::atomic<bool> unplugged_{false};
  int wake_ = -1;
  SequenceCounter counter_;
  JpegDecoder jpeg_;
  KeptJpeg kept_jpeg_;
};

}  // namespace

OpenedCamera openLibcameraCamera(const CameraOptions& options) {
  auto camera = std::make_unique<LibcameraCamera>(options);
  const LibcameraCamera::Problem problem = camera->open();
  if (!problem.text.empty()) return {nullptr, options.device + ": " + problem.text, problem.may_heal};
  return {std::move(camera), "", false};
}

}  // namespace edgeslam
