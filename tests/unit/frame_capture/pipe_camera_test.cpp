// The driver of docs/camera_drivers.md does what the interface asks of one.
#include "unit/frame_capture/pipe_camera.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <opencv2/core.hpp>

#include "drivers/frame_capture/reopening_camera.h"

namespace edgeslam {
namespace {

constexpr std::chrono::milliseconds short_time(20), long_time(5000);

class PipeCameraTest : public testing::Test {
 protected:
  PipeCameraTest() {
    char name[] = "/tmp/edgeslam-pipe-XXXXXX";
    folder_ = ::mkdtemp(name);
    options_.device = "pipe:" + path();
    options_.width = 8;
    options_.height = 6;
    ::mkfifo(path().c_str(), 0600);
  }
  ~PipeCameraTest() override { std::filesystem::remove_all(folder_); }

  std::string path() const { return folder_ + "/frames"; }
  int writer() const { return ::open(path().c_str(), O_WRONLY | O_CLOEXEC); }
  static void write(int writer, std::size_t bytes, char grey) {
    const std::string pixels(bytes, grey);
    ASSERT_EQ(::write(writer, pixels.data(), bytes), static_cast<ssize_t>(bytes));
  }

  std::string folder_;
  CameraOptions options_;
  cv::Mat grey_;
};

TEST_F(PipeCameraTest, GivesWholeFramesInOrderAndNoneWhereNoneIsThere) {
  const OpenedCamera opened = openPipeCamera(options_);
  ASSERT_NE(opened.camera, nullptr) << opened.problem;
  EXPECT_EQ(opened.camera->next(grey_, short_time).event, CaptureEvent::none_yet);
  const int to = writer();
  write(to, 47, 'a');
  EXPECT_EQ(opened.camera->next(grey_, short_time).event, CaptureEvent::none_yet) << "half a frame is none";
  write(to, 1 + 48, 'b');
  const Capture first = opened.camera->next(grey_, long_time);
  ASSERT_EQ(first.event, CaptureEvent::frame);
  EXPECT_EQ(grey_.size(), cv::Size(8, 6));
  EXPECT_EQ(grey_.at<unsigned char>(5, 6), 'a');
  EXPECT_EQ(grey_.at<unsigned char>(5, 7), 'b');
  const Capture second = opened.camera->next(grey_, long_time);
  ASSERT_EQ(second.event, CaptureEvent::frame);
  EXPECT_EQ(cv::countNonZero(grey_ != 'b'), 0);
  EXPECT_EQ(second.frame.sequence, first.frame.sequence + 1);
  EXPECT_GT(second.frame.time_ns, first.frame.time_ns);
  ::close(to);
  EXPECT_EQ(opened.camera->next(grey_, long_time).event, CaptureEvent::interrupted);
}

TEST_F(PipeCameraTest, ComesBackWhenItIsOpenedAgain) {
  OpenedCamera first = openPipeCamera(options_);
  ASSERT_NE(first.camera, nullptr);
  ReopeningCamera camera([this] { return openPipeCamera(options_); }, std::move(first.camera));
  int to = writer();
  write(to, 48, 'a');
  EXPECT_EQ(camera.next(grey_, long_time).event, CaptureEvent::frame);
  ::close(to);
  EXPECT_EQ(camera.next(grey_, long_time).event, CaptureEvent::interrupted);
  while (!camera.isOpen()) camera.next(grey_, short_time);
  to = writer();
  write(to, 48, 'c');
  Capture again;
  while (again.event != CaptureEvent::frame) again = camera.next(grey_, long_time);
  EXPECT_TRUE(again.frame.after_interruption);
  EXPECT_EQ(again.frame.sequence, 1);
  ::close(to);
}

TEST_F(PipeCameraTest, SaysWhatIsWrong) {
  std::filesystem::remove(path());
  const OpenedCamera missing = openPipeCamera(options_);
  EXPECT_EQ(missing.camera, nullptr);
  EXPECT_TRUE(missing.may_heal);
  EXPECT_NE(missing.problem.find("No such file"), std::string::npos);
  options_.width = 0;
  EXPECT_FALSE(openPipeCamera(options_).may_heal);
}

}  // namespace
}  // namespace edgeslam
