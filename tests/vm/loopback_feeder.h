// Feeds frames into a v4l2loopback device, as a camera would give them.
#pragma once

#include <fcntl.h>
#include <linux/videodev2.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <opencv2/core/mat.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "drivers/v4l2/system_calls.h"

namespace edgeslam {

enum class FeedingOrder {
  once,            // to the last one, which stays
  around,          // from the last one on to the first
  there_and_back,  // backwards from the last one: the scene never jumps
};

// The index of the n-th frame that is fed, of `count`; -1: none is left.
inline std::int64_t fedIndex(FeedingOrder order, std::int64_t n, std::int64_t count) {
  if (order == FeedingOrder::once) return n < count ? n : -1;
  if (order == FeedingOrder::around || count < 2) return n % count;
  const std::int64_t phase = n % (2 * count - 2);
  return phase < count ? phase : 2 * count - 2 - phase;
}

// Writes GREY frames to the device's input while it lives. Throws std::runtime_error where the device refuses.
class LoopbackFeeder {
 public:
  // `frames`: CV_8U, continuous, all of one size. The first frame of all is written at once.
  LoopbackFeeder(const std::string& device, std::vector<cv::Mat> frames, double frames_per_second, FeedingOrder order)
      : frames_(std::move(frames)),
        order_(order),
        interval_(std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / frames_per_second))) {
    file_ = ::open(device.c_str(), O_RDWR | O_CLOEXEC);
    if (file_ < 0) throw std::runtime_error(device + ": " + std::strerror(errno));
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    format.fmt.pix.width = static_cast<unsigned>(frames_[0].cols);
    format.fmt.pix.height = static_cast<unsigned>(frames_[0].rows);
    format.fmt.pix.pixelformat = V4L2_PIX_FMT_GREY;
    format.fmt.pix.field = V4L2_FIELD_NONE;
    format.fmt.pix.bytesperline = format.fmt.pix.width;
    format.fmt.pix.sizeimage = format.fmt.pix.width * format.fmt.pix.height;
    if (kernel().control(file_, VIDIOC_S_FMT, &format) != 0 || !write(frames_[0])) {
      const std::string problem = std::strerror(errno);
      ::close(file_);
      throw std::runtime_error(device + " does not take frames: " + problem);
    }
    tellRate(frames_per_second);
    thread_ = std::thread([this] { run(); });
  }
  ~LoopbackFeeder() {
    stop_ = true;
    thread_.join();
    ::close(file_);
  }
  LoopbackFeeder(const LoopbackFeeder&) = delete;
  LoopbackFeeder& operator=(const LoopbackFeeder&) = delete;

  void pause(bool paused) { paused_ = paused; }
  // The robot stands still: the same frame again and again.
  void hold(bool held) { held_ = held; }
  // A hand on the lens: dark frames in their place.
  void cover(bool covered) { covered_ = covered; }
  // How far it came in the order of the frames: the number of the latest one, from 0.
  std::int64_t position() const { return position_; }
  // Of `once`: the last frame was written.
  bool ended() const { return indexAt(position_ + 1) < 0; }

 private:
  // To those that read: by it they know when a frame is late.
  void tellRate(double frames_per_second) {
    v4l2_streamparm rate{};
    rate.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    rate.parm.output.timeperframe = {1000, static_cast<unsigned>(1000 * frames_per_second)};
    kernel().control(file_, VIDIOC_S_PARM, &rate);
  }
  bool write(const cv::Mat& frame) {
    return ::write(file_, frame.data, frame.total()) == static_cast<ssize_t>(frame.total());
  }
  std::int64_t indexAt(std::int64_t position) const {
    return fedIndex(order_, position, static_cast<std::int64_t>(frames_.size()));
  }
  void run() {
    const cv::Mat dark(frames_[0].size(), CV_8U, cv::Scalar(6));
    auto due = std::chrono::steady_clock::now();
    while (!stop_) {
      std::this_thread::sleep_until(due += interval_);
      if (paused_) continue;
      const std::int64_t next = held_ || ended() ? position_.load() : position_ + 1;
      if (write(covered_ ? dark : frames_[static_cast<std::size_t>(indexAt(next))])) position_ = next;
    }
  }

  std::vector<cv::Mat> frames_;
  FeedingOrder order_;
  std::chrono::nanoseconds interval_;
  int file_ = -1;
  std::atomic<bool> stop_{false}, paused_{false}, held_{false}, covered_{false};
  std::atomic<std::int64_t> position_{0};
  std::thread thread_;
};

}  // namespace edgeslam
