// The V4L2 driver against the kernel's test camera (vivid), in a virtual machine: run.sh.
#include <gtest/gtest.h>

#include <map>
#include <opencv2/core.hpp>
#include <vector>

#include "app/cameras_command.h"
#include "drivers/cameras/open_camera.h"
#include "drivers/v4l2/offered_formats.h"
#include "drivers/v4l2/v4l2_camera.h"
#include "vm/vivid_device.h"

namespace edgeslam {
namespace {

constexpr std::int64_t ms = 1'000'000;
constexpr int buffers = 8;

// Which of the devices that run.sh makes: a webcam, and one of the multi-planar kind.
constexpr int webcam = 0, multi_planar = 1;

CameraOptions optionsOf(int device) {
  CameraOptions options;
  options.device = vividNode(device);
  options.every_frame = true;
  options.buffers = buffers;
  options.width = 640;
  options.height = 360;
  return options;
}

class Vivid : public testing::Test {
 protected:
  void SetUp() override {
    for (const int device : {webcam, multi_planar}) {
      const std::string node = vividNode(device);
      ASSERT_NE(node, "") << device;
      setVivid(node, "Timestamp Source", 1);  // its default stamps frames with times to come
      setVivid(node, "OSD Text Mode", 2);     // none
      setVivid(node, "Percentage of Dropped Buffers", 0);
    }
  }
  std::unique_ptr<LiveCamera> open(const CameraOptions& options) {
    OpenedCamera opened = openV4l2Camera(options);
    EXPECT_TRUE(opened.camera) << opened.problem;
    return std::move(opened.camera);
  }
  Capture next(LiveCamera& camera, int timeout_ms = 500) {
    return camera.next(grey_, std::chrono::milliseconds(timeout_ms));
  }
  // Reads `count` frames; the sums of what was lost and damaged.
  struct Read {
    int frames = 0, damaged = 0;
    std::int64_t lost = 0, lost_by_us = 0, first_ns = 0, last_ns = 0, longest_gap_ns = 0, latest_ns = 0;
    std::int64_t last_sequence = 0;
  };
  Read read(LiveCamera& camera, int count) {
    Read sum;
    while (sum.frames + sum.damaged < count) {
      const std::int64_t now_before_ns = now_ns();
      const Capture capture = next(camera);
      if (capture.event == CaptureEvent::damaged_frame) ++sum.damaged;
      if (capture.event == CaptureEvent::none_yet || capture.event == CaptureEvent::interrupted) {
        ADD_FAILURE() << "the stream ended: " << capture.message;
        break;
      }
      sum.lost += capture.frame.lost_before;
      // The driver lacked a buffer only where the frame before was taken when all others were filled.
      if (now_before_ns - sum.last_ns > (buffers - 2) * camera.stream().frame_interval_ns && sum.last_ns > 0) {
        sum.lost_by_us += capture.frame.lost_before;
      }
      sum.last_sequence = capture.frame.sequence;
      if (capture.event != CaptureEvent::frame) continue;
      const std::int64_t time_ns = capture.frame.time_ns;
      if (sum.frames++ == 0) sum.first_ns = time_ns;
      if (sum.frames > 1) sum.longest_gap_ns = std::max(sum.longest_gap_ns, time_ns - sum.last_ns);
      sum.latest_ns = std::max(sum.latest_ns, now_ns() - time_ns);
      sum.last_ns = time_ns;
    }
    return sum;
  }

  cv::Mat grey_;
};

// What vivid's generator makes of a colour: full range by ITU-R BT.709 for grey alone, 16 to 235 by BT.601 for YUV; RGB
// is weighed here, by BT.601.
struct Brightness {
  double grey, yuv, rgb;
};

TEST_F(Vivid, EveryFormatGivesTheTestPattern) {
  const std::map<int, Brightness> patterns{
      {5, {0, 16, 0}}, {6, {254, 235, 255}}, {7, {54, 81, 76}}, {8, {182, 145, 150}}, {9, {18, 41, 29}}};
  for (const int device : {webcam, multi_planar}) {
    const std::string node = vividNode(device);
    const OpenedDevice opened = openCaptureDevice(kernel(), node);
    ASSERT_TRUE(opened.device);
    int formats = 0;
    for (const OfferedFormat& format : offeredFormats(*opened.device)) {
      if (!format.format) continue;
      ++formats;
      const std::string& name = format.name;
      const bool is_yuv = name.find('U') != std::string::npos || name.find("NV") == 0;
      const bool is_rgb = name.find("24") != std::string::npos;
      std::cout << node << " " << name << ":";
      CameraOptions options = optionsOf(device);
      options.format = name;
      const auto take = [&](int pattern) {
        setVivid(node, "Test Pattern", pattern);
        const auto camera = open(options);
        ASSERT_TRUE(camera);
        ASSERT_EQ(next(*camera).event, CaptureEvent::frame) << name;
      };
      for (const auto& [pattern, brightness] : patterns) {
        take(pattern);
        const double expected = is_yuv ? brightness.yuv : is_rgb ? brightness.rgb : brightness.grey;
        double least = 0, largest = 0;
        cv::minMaxLoc(grey_, &least, &largest);
        std::cout << " " << least << ".." << largest;
        EXPECT_NEAR(least, expected, 1.5) << name << " " << pattern;
        EXPECT_NEAR(largest, expected, 1.5) << name << " " << pattern;
      }
      take(20);  // a ramp from black on the left to white on the right, a grey level every 2.5 pixels
      const double range = is_yuv ? 219 : 255;
      double worst = 0;
      for (int x = 0; x < 640; ++x) {
        const double expected = (is_yuv ? 16 : 0) + range * x / 640;
        for (const int y : {0, 100, 359}) worst = std::max(worst, std::abs(grey_.at<std::uint8_t>(y, x) - expected));
      }
      std::cout << ", ramp within " << worst << "\n";
      EXPECT_LT(worst, 2.5) << name;
    }
    EXPECT_GE(formats, 10);
    setVivid(node, "Test Pattern", 0);
  }
}

// vivid's own thread leaves out frames where the machine is busy. Those that were lost for want of a buffer are ours
// and must be none; of some tries the best is told.
class VividRate : public Vivid {
 protected:
  void expectRate(const CameraOptions& options, double wanted) {
    Read best;
    best.lost = INT64_MAX;
    double best_rate = 0;
    for (int attempt = 0; attempt < 8 && best.lost > 0; ++attempt) {
      const auto camera = open(options);
      ASSERT_TRUE(camera);
      read(*camera, 5);
      const int frames = static_cast<int>(2 * wanted);
      const Read sum = read(*camera, frames);
      const auto duration_ns = static_cast<double>(sum.last_ns - sum.first_ns);
      const double rate = (frames - 1) * 1e9 / duration_ns;
      EXPECT_NEAR(static_cast<double>(frames - 1 + sum.lost) * 1e9 / duration_ns, wanted, 0.04 * wanted);
      std::cout << camera->stream().format << ": " << rate << " frames/s, " << sum.lost << " lost (" << sum.lost_by_us
                << " for want of a buffer), longest gap " << sum.longest_gap_ns / ms << " ms, at most "
                << sum.latest_ns / ms << " ms after the stamp\n";
      EXPECT_EQ(sum.damaged, 0);
      EXPECT_EQ(sum.lost_by_us, 0);
      if (sum.lost > best.lost) continue;
      best = sum;
      best_rate = rate;
    }
    EXPECT_GT(best_rate, 0.75 * wanted);
  }
};

TEST_F(VividRate, ThirtyFramesASecondWithoutLoss) {
  CameraOptions options = optionsOf(webcam);
  options.frame_rate = 30;
  expectRate(options, 30);
}

TEST_F(VividRate, SixtyFramesASecondWithoutLoss) {
  CameraOptions options = optionsOf(webcam);
  options.width = 320;
  options.height = 180;
  options.frame_rate = 60;
  expectRate(options, 60);
}

TEST_F(Vivid, DroppedBuffersAreCounted) {
  const CameraOptions options = optionsOf(webcam);
  const auto camera = open(options);
  ASSERT_TRUE(camera);
  setVivid(options.device, "Percentage of Dropped Buffers", 20);
  const Read sum = read(*camera, 60);
  std::cout << sum.lost << " lost beside 60 frames\n";
  EXPECT_GT(sum.lost, 3);
  EXPECT_LT(sum.lost, 40);
  EXPECT_EQ(sum.last_sequence, 59 + sum.lost);
}

TEST_F(Vivid, ABufferMarkedAsBrokenIsOneDamagedFrame) {
  const CameraOptions options = optionsOf(webcam);
  const auto camera = open(options);
  ASSERT_TRUE(camera);
  read(*camera, 5);
  setVivid(options.device, "Inject V4L2_BUF_FLAG_ERROR", 1);
  const Read sum = read(*camera, 20);
  EXPECT_EQ(sum.damaged, 1);
}

TEST_F(Vivid, SequenceNumbersGoOnWhereTheDriversWrap) {
  const CameraOptions options = optionsOf(webcam);
  setVivid(options.device, "Wrap Sequence Number", 1);
  const auto camera = open(options);
  ASSERT_TRUE(camera);
  const Read sum = read(*camera, 200);
  setVivid(options.device, "Wrap Sequence Number", 0);
  EXPECT_EQ(sum.last_sequence, 199 + sum.lost);
  EXPECT_LT(sum.lost, 100);  // what a busy machine costs, not the 2^32 of the wrap
}

TEST_F(Vivid, TimeStampsThatWrapAreReplacedByTheTimeOfArrival) {
  const CameraOptions options = optionsOf(webcam);
  setVivid(options.device, "Wrap Timestamp", 1);
  const auto camera = open(options);
  ASSERT_TRUE(camera);
  const std::int64_t before_ns = now_ns();
  const Capture capture = next(*camera);
  setVivid(options.device, "Wrap Timestamp", 0);
  ASSERT_EQ(capture.event, CaptureEvent::frame);
  EXPECT_EQ(capture.frame.time_meaning, TimeMeaning::arrival);
  EXPECT_GE(capture.frame.time_ns, before_ns);
  EXPECT_LE(capture.frame.time_ns, now_ns());
}

TEST_F(Vivid, ErrorsInOpeningAreToldAndPass) {
  for (const char* error :
       {"Inject VIDIOC_STREAMON Error", "Inject VIDIOC_REQBUFS Error", "Inject VIDIOC_QBUF Error"}) {
    const CameraOptions options = optionsOf(webcam);
    setVivid(options.device, error, 1);
    const OpenedCamera failed = openV4l2Camera(options);
    std::cout << error << ": " << failed.problem << "\n";
    EXPECT_FALSE(failed.camera);
    EXPECT_EQ(failed.problem.rfind(options.device + ": ", 0), 0U) << failed.problem;
    EXPECT_TRUE(open(options));
  }
}

TEST_F(Vivid, TheDriverTellsWhatItRefuses) {
  CameraOptions options = optionsOf(webcam);
  const auto problemOf = [&] {
    const OpenedCamera opened = openV4l2Camera(options);
    EXPECT_FALSE(opened.camera);
    std::cout << opened.problem.substr(0, 300) << "\n";
    return opened.problem;
  };
  options.controls = {{"brightness", "300"}};
  EXPECT_NE(problemOf().find("0 to 255"), std::string::npos);
  options.controls = {{"test_pattern", "Hypnosis"}};
  EXPECT_NE(problemOf().find("Gray Ramp"), std::string::npos);
  options.controls = {};
  options.frame_rate = 50;
  EXPECT_NE(problemOf().find("frames/s"), std::string::npos);
  options.frame_rate = 0;
  options.width = 641;
  EXPECT_NE(problemOf().find("641 x 360"), std::string::npos);
  options.width = 640;
  options.controls = {{"brightness", "77"}, {"gain", "10"}};
  EXPECT_TRUE(open(options));
}

TEST_F(Vivid, AnotherProgramsStreamIsToldAsBusy) {
  const CameraOptions options = optionsOf(webcam);
  const auto first = open(options);
  const OpenedCamera second = openV4l2Camera(options);
  EXPECT_FALSE(second.camera);
  EXPECT_TRUE(second.may_heal);
  std::cout << second.problem << "\n";
  EXPECT_NE(second.problem.find("another program"), std::string::npos) << second.problem;
}

TEST_F(Vivid, CamerasAreListedWithTheirFormatsAndControls) {
  const std::vector<ListedCamera> cameras = listV4l2Cameras();
  const std::string text = camerasText(cameras, {});
  std::cout << text.substr(0, 1500) << "...\n";
  EXPECT_NE(text.find("GREY 320 x 180"), std::string::npos);
  EXPECT_NE(text.find("brightness: "), std::string::npos);
  EXPECT_NE(text.find("capture:"), std::string::npos);
}

// Breaks the stream in some way, and expects to be told within half a second and to have frames again after `repair`.
class BrokenStream : public Vivid {
 protected:
  template <typename Break, typename Repair>
  void expectRecovery(const Break& break_it, const Repair& repair) {
    CameraOptions options = optionsOf(webcam);
    options.every_frame = false;
    ReopeningCamera camera(
        [options]() mutable {
          options.device = vividNode(webcam);  // its number may have changed, which by-id and by-path names hide
          if (options.device.empty()) options.device = "/dev/video-unplugged";
          return openCamera(options);
        },
        open(options));
    for (int i = 0; i < 10; ++i) ASSERT_EQ(next(camera).event, CaptureEvent::frame);
    const std::int64_t broken_ns = now_ns();
    break_it();
    Capture capture;
    do {
      capture = next(camera, 100);
    } while (capture.event != CaptureEvent::interrupted && now_ns() - broken_ns < 3000 * ms);
    std::cout << "told after " << (now_ns() - broken_ns) / ms << " ms: " << capture.message << "\n";
    ASSERT_EQ(capture.event, CaptureEvent::interrupted);
    EXPECT_LT(now_ns() - broken_ns, 500 * ms);
    bool came_back = false;
    for (int i = 0; i < 5; ++i) came_back |= next(camera, 100).frame.after_interruption;
    repair();
    const std::int64_t repaired_ns = now_ns();
    do {
      capture = next(camera, 100);
      if (capture.event == CaptureEvent::interrupted) std::cout << "  " << capture.message << "\n";
    } while (capture.event != CaptureEvent::frame && now_ns() - repaired_ns < 15'000 * ms);
    std::cout << "frames again after " << (now_ns() - repaired_ns) / ms << " ms\n";
    ASSERT_EQ(capture.event, CaptureEvent::frame);
    EXPECT_TRUE(came_back || capture.frame.after_interruption);
    EXPECT_EQ(next(camera).event, CaptureEvent::frame);
  }
};

TEST_F(BrokenStream, AFatalErrorOfTheDriver) {
  expectRecovery([] { setVivid(vividNode(webcam), "Inject Fatal Streaming Error", 1); }, [] {});
}

TEST_F(BrokenStream, UnboundAndBoundAgain) {
  expectRecovery([] { bindVivid(false); }, [] { bindVivid(true); });
}

TEST_F(BrokenStream, Disconnected) {
  expectRecovery([] { setVivid(vividNode(webcam), "Disconnect", 1); },
                 [] {
                   bindVivid(false);
                   sleep_ms(200);
                   bindVivid(true);
                 });
}

}  // namespace
}  // namespace edgeslam
