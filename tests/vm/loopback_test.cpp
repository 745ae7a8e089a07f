// Frames fed through v4l2loopback come out of the driver as they went in, in a virtual machine: run.sh.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <thread>
#include <vector>

#include "app/open_camera.h"
#include "dataset/simulator.h"
#include "drivers/frame_capture/reopening_camera.h"
#include "vm/vivid_device.h"

namespace edgeslam {
namespace {

constexpr std::int64_t ms = 1'000'000;
constexpr int width = 160, height = 120;

// Writes frames to the loopback's input at 30/s while it lives.
class Feeder {
 public:
  Feeder(const std::string& path, std::vector<cv::Mat> frames) : frames_(std::move(frames)) {
    file_ = ::open(path.c_str(), O_RDWR);
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    format.fmt.pix.width = width;
    format.fmt.pix.height = height;
    format.fmt.pix.pixelformat = V4L2_PIX_FMT_GREY;
    format.fmt.pix.field = V4L2_FIELD_NONE;
    format.fmt.pix.bytesperline = width;
    format.fmt.pix.sizeimage = width * height;
    EXPECT_EQ(kernel().control(file_, VIDIOC_S_FMT, &format), 0);
    write(0);
    thread_ = std::thread([this] { run(); });
  }
  ~Feeder() {
    stop_ = true;
    thread_.join();
    close(file_);
  }
  void pause(bool paused) { paused_ = paused; }

 private:
  void write(std::size_t i) {
    const cv::Mat& frame = frames_[i % frames_.size()];
    EXPECT_EQ(::write(file_, frame.data, frame.total()), static_cast<ssize_t>(frame.total()));
  }
  void run() {
    auto due = std::chrono::steady_clock::now();
    for (std::size_t i = 1; !stop_;) {
      std::this_thread::sleep_until(due += std::chrono::milliseconds(33));
      if (!paused_) write(i++);
    }
  }

  std::vector<cv::Mat> frames_;
  int file_ = -1;
  std::atomic<bool> stop_{false}, paused_{false};
  std::thread thread_;
};

std::vector<cv::Mat> sequence(int count) {
  SimulationOptions options;
  options.frames = count;
  options.width = width;
  options.height = height;
  const SimulatedSequence simulated = makeSequence(options);
  std::vector<cv::Mat> frames;
  for (int i = 0; i < count; ++i) frames.push_back(simulated.frame(i).grey);
  return frames;
}

int indexOf(const cv::Mat& grey, const std::vector<cv::Mat>& frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (cv::norm(grey, frames[i], cv::NORM_INF) == 0) return static_cast<int>(i);
  }
  return -1;
}

const char* loopback() { return std::getenv("EDGESLAM_LOOPBACK"); }

TEST(Loopback, ASequenceComesOutToTheByteAndInOrder) {
  if (loopback() == nullptr) GTEST_SKIP() << "no v4l2loopback here";
  const std::vector<cv::Mat> frames = sequence(20);
  const Feeder feeder(loopback(), frames);
  CameraOptions options;
  options.device = loopback();
  options.every_frame = true;
  const OpenedCamera opened = openCamera(options);
  ASSERT_TRUE(opened.camera) << opened.problem;
  std::cout << opened.camera->stream().camera << ", " << opened.camera->stream().format << "\n";
  int last = -1;
  std::int64_t lost = 0, last_ns = 0;
  for (int i = 0; i < 90; ++i) {
    cv::Mat grey;
    const Capture capture = opened.camera->next(grey, std::chrono::milliseconds(500));
    ASSERT_EQ(capture.event, CaptureEvent::frame) << capture.message;
    EXPECT_GT(capture.frame.time_ns, last_ns);
    EXPECT_LT(now_ns() - capture.frame.time_ns, 200 * ms);
    last_ns = capture.frame.time_ns;
    const int index = indexOf(grey, frames);
    ASSERT_GE(index, 0) << "frame " << i << " is none of those fed";
    if (last >= 0) {
      EXPECT_EQ(index, (last + 1 + capture.frame.lost_before) % 20) << i;
    }
    lost += capture.frame.lost_before;
    last = index;
  }
  std::cout << "90 frames, " << lost << " lost\n";
}

TEST(Loopback, AFrozenStreamIsToldWithinHalfASecondAndComesBack) {
  if (loopback() == nullptr) GTEST_SKIP() << "no v4l2loopback here";
  Feeder feeder(loopback(), sequence(3));
  CameraOptions options;
  options.device = loopback();
  const auto camera = openLastingCamera(options);
  cv::Mat grey;
  const auto next = [&] { return camera->next(grey, std::chrono::milliseconds(100)); };
  for (int i = 0; i < 20; ++i) next();
  feeder.pause(true);
  const std::int64_t frozen_ns = now_ns();
  Capture capture;
  do {
    capture = next();
  } while (capture.event != CaptureEvent::interrupted && now_ns() - frozen_ns < 3000 * ms);
  std::cout << "told after " << (now_ns() - frozen_ns) / ms << " ms: " << capture.message << "\n";
  EXPECT_EQ(capture.event, CaptureEvent::interrupted);
  EXPECT_LT(now_ns() - frozen_ns, 550 * ms);  // up to one interval more since the last frame
  feeder.pause(false);
  const std::int64_t repaired_ns = now_ns();
  do {
    capture = next();
  } while (capture.event != CaptureEvent::frame && now_ns() - repaired_ns < 10'000 * ms);
  std::cout << "frames again after " << (now_ns() - repaired_ns) / ms << " ms\n";
  EXPECT_EQ(capture.event, CaptureEvent::frame);
  EXPECT_TRUE(capture.frame.after_interruption);
}

}  // namespace
}  // namespace edgeslam
