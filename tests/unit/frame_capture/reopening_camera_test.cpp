#include "drivers/frame_capture/reopening_camera.h"

#include <gtest/gtest.h>

#include <deque>
#include <vector>

#include "unit/frame_capture/stream_times.h"

namespace edgeslam {
namespace {

// A camera on a clock that only it and waiting move.
struct World {
  std::int64_t now_ns = 1000 * ms;
  bool plugged = true;
  bool frozen = false;
  bool stamps_stand_still = false;
  bool damaged = false;
  bool is_recording = false;
  bool keeps_jpeg = false;  // the camera that is open
  int width = 4;
  int opened = 0;
  int attempts = 0;
};

class ScriptedCamera : public LiveCamera {
 public:
  explicit ScriptedCamera(World& world) : world_(world) {
    world.keeps_jpeg = false;
    stream_ = {"scripted", "GREY", world.width, 3, stream_interval_ns, world.is_recording};
  }
  Capture next(cv::Mat& grey, std::chrono::nanoseconds timeout) override {
    if (!world_.plugged) return {CaptureEvent::interrupted, {}, "unplugged"};
    if (world_.frozen || timeout.count() < stream_interval_ns) {
      world_.now_ns += timeout.count();
      return {};
    }
    world_.now_ns += stream_interval_ns;
    if (world_.damaged) return {CaptureEvent::damaged_frame, {}, "torn"};
    grey.create(3, world_.width, CV_8U);
    Capture capture{CaptureEvent::frame, {}, ""};
    capture.frame.time_ns = world_.stamps_stand_still ? 5 : world_.now_ns;
    capture.frame.sequence = sequence_++;
    return capture;
  }
  const StreamDescription& stream() const override { return stream_; }
  void keepJpeg(bool keep) override { world_.keeps_jpeg = keep; }

 private:
  World& world_;
  StreamDescription stream_;
  std::int64_t sequence_ = 0;
};

class ReopeningCameraTest : public testing::Test {
 protected:
  OpenedCamera open() {
    ++world_.attempts;
    if (!world_.plugged) return {nullptr, "there is no camera", true};
    ++world_.opened;
    return {std::make_unique<ScriptedCamera>(world_), "", false};
  }
  CaptureClock clock() {
    return {[this] { return world_.now_ns; }, [this](std::int64_t duration_ns) { world_.now_ns += duration_ns; }};
  }
  Capture next() { return camera_.next(grey_, std::chrono::milliseconds(100)); }
  // Calls until one of the events comes or `limit_ns` passed.
  Capture until(CaptureEvent event, std::int64_t limit_ns) {
    const std::int64_t end_ns = world_.now_ns + limit_ns;
    while (world_.now_ns < end_ns) {
      const Capture capture = next();
      if (capture.event == event) return capture;
    }
    ADD_FAILURE() << "did not come";
    return {};
  }

  World world_;
  cv::Mat grey_;
  ReopeningCamera camera_{[this] { return open(); }, std::make_unique<ScriptedCamera>(world_), WatchPolicy{}, clock()};
};

TEST_F(ReopeningCameraTest, NeverBlocksLongerThanTheTimeout) {
  for (int i = 0; i < 300; ++i) {
    if (i == 50) world_.frozen = true;
    if (i == 100) world_.plugged = false;
    if (i == 200) world_.plugged = !(world_.frozen = false);
    const std::int64_t before = world_.now_ns;
    next();
    EXPECT_LE(world_.now_ns - before, 100 * ms) << i;
  }
}

TEST_F(ReopeningCameraTest, AnUnpluggedCameraIsToldOnceForEachReasonAndComesBack) {
  EXPECT_EQ(next().event, CaptureEvent::frame);
  const std::int64_t last_sequence = next().frame.sequence;
  world_.plugged = false;
  EXPECT_EQ(next().message, "unplugged");
  EXPECT_EQ(until(CaptureEvent::interrupted, 1000 * ms).message, "there is no camera");
  EXPECT_FALSE(camera_.isOpen());
  for (int i = 0; i < 300; ++i) EXPECT_EQ(next().event, CaptureEvent::none_yet);
  EXPECT_LT(world_.attempts, 15);
  world_.plugged = true;
  const Capture back = until(CaptureEvent::frame, 6000 * ms);
  EXPECT_TRUE(back.frame.after_interruption);
  EXPECT_GT(back.frame.sequence, last_sequence);
  EXPECT_FALSE(next().frame.after_interruption);
}

TEST_F(ReopeningCameraTest, WhatIsKeptOfFramesIsKeptAfterAnInterruptionToo) {
  camera_.keepJpeg(true);
  EXPECT_TRUE(world_.keeps_jpeg);
  world_.plugged = false;
  EXPECT_EQ(next().event, CaptureEvent::interrupted);
  world_.plugged = true;
  until(CaptureEvent::frame, 6000 * ms);
  EXPECT_TRUE(world_.keeps_jpeg);
  camera_.keepJpeg(false);
  EXPECT_FALSE(world_.keeps_jpeg);
}

TEST_F(ReopeningCameraTest, AFrozenStreamIsNoticedWithinHalfASecondAndOpenedAgain) {
  EXPECT_EQ(next().event, CaptureEvent::frame);
  world_.frozen = true;
  const std::int64_t frozen_since = world_.now_ns;
  EXPECT_NE(until(CaptureEvent::interrupted, 1000 * ms).message.find("frozen"), std::string::npos);
  EXPECT_LE(world_.now_ns - frozen_since, 500 * ms);
  world_.frozen = false;
  EXPECT_TRUE(until(CaptureEvent::frame, 1000 * ms).frame.after_interruption);
  EXPECT_EQ(world_.opened, 1);
}

TEST_F(ReopeningCameraTest, TimeStampsThatStandStillAreDamagedFrames) {
  EXPECT_EQ(next().event, CaptureEvent::frame);
  world_.stamps_stand_still = true;
  EXPECT_EQ(next().event, CaptureEvent::damaged_frame);
  world_.stamps_stand_still = false;
  EXPECT_EQ(next().event, CaptureEvent::frame);
}

TEST_F(ReopeningCameraTest, ACameraThatGivesOnlyDamagedFramesIsOpenedAgain) {
  EXPECT_EQ(next().event, CaptureEvent::frame);
  world_.damaged = true;
  EXPECT_NE(until(CaptureEvent::interrupted, 5000 * ms).message.find("torn"), std::string::npos);
}

TEST_F(ReopeningCameraTest, APauseOfARecordingIsNoReasonToBeginItAgain) {
  world_.is_recording = true;
  ReopeningCamera recording([this] { return open(); }, std::make_unique<ScriptedCamera>(world_), WatchPolicy{},
                            clock());
  EXPECT_EQ(recording.next(grey_, std::chrono::milliseconds(100)).event, CaptureEvent::frame);
  world_.frozen = true;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(recording.next(grey_, std::chrono::milliseconds(100)).event, CaptureEvent::none_yet);
  }
  world_.frozen = false;
  EXPECT_EQ(recording.next(grey_, std::chrono::milliseconds(100)).frame.sequence, 1);
}

TEST_F(ReopeningCameraTest, AnotherSizeIsRefused) {
  EXPECT_EQ(next().event, CaptureEvent::frame);
  world_.plugged = false;
  next();
  world_.plugged = true;
  world_.width = 8;
  EXPECT_NE(until(CaptureEvent::interrupted, 1000 * ms).message.find("another size"), std::string::npos);
  world_.width = 4;
  EXPECT_EQ(until(CaptureEvent::frame, 6000 * ms).event, CaptureEvent::frame);
  EXPECT_EQ(grey_.cols, 4);
}

TEST_F(ReopeningCameraTest, OneThatIsNotThereYetIsWaitedFor) {
  world_.plugged = false;
  StreamDescription expected;
  expected.width = 4;
  expected.height = 3;
  ReopeningCamera camera([this] { return open(); }, expected, "there is no camera", WatchPolicy{}, clock());
  EXPECT_FALSE(camera.isOpen());
  EXPECT_EQ(camera.stream().width, 4);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(camera.next(grey_, std::chrono::milliseconds(100)).event, CaptureEvent::none_yet) << "told before";
  }
  EXPECT_GT(world_.attempts, 3);
  EXPECT_LT(world_.attempts, 20) << "with growing waits";
  world_.plugged = true;
  Capture capture;
  for (int i = 0; i < 100 && capture.event != CaptureEvent::frame; ++i) {
    capture = camera.next(grey_, std::chrono::milliseconds(100));
  }
  EXPECT_EQ(capture.event, CaptureEvent::frame);
  EXPECT_TRUE(capture.frame.after_interruption);
  EXPECT_EQ(capture.frame.sequence, 0);
}

TEST_F(ReopeningCameraTest, AnotherSizeThanExpectedIsAnError) {
  StreamDescription expected;
  expected.width = 640;
  expected.height = 480;
  ReopeningCamera camera([this] { return open(); }, expected, "", WatchPolicy{}, clock());
  Capture capture;
  for (int i = 0; i < 100 && capture.event == CaptureEvent::none_yet; ++i) {
    capture = camera.next(grey_, std::chrono::milliseconds(100));
  }
  EXPECT_EQ(capture.event, CaptureEvent::interrupted);
  EXPECT_NE(capture.message.find("expected are 640 x 480"), std::string::npos) << capture.message;
}

}  // namespace
}  // namespace edgeslam
