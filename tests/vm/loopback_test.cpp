// Frames fed through v4l2loopback come out of the driver as they went in, in a virtual machine: run.sh.
#include <gtest/gtest.h>

#include <cstdlib>
#include <opencv2/core.hpp>
#include <vector>

#include "drivers/cameras/open_camera.h"
#include "drivers/frame_capture/reopening_camera.h"
#include "simulator/simulator.h"
#include "vm/loopback_feeder.h"
#include "vm/vivid_device.h"

namespace edgeslam {
namespace {

constexpr std::int64_t ms = 1'000'000;
constexpr int width = 160, height = 120;
constexpr double frames_per_second = 30;

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
  const LoopbackFeeder feeder(loopback(), frames, frames_per_second, FeedingOrder::around);
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
  LoopbackFeeder feeder(loopback(), sequence(3), frames_per_second, FeedingOrder::around);
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
