#include "drivers/v4l2/v4l2_camera.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "unit/frame_capture/stream_times.h"
#include "unit/image_formats/made_jpeg.h"
#include "unit/v4l2/fake_driver.h"

namespace edgeslam {
namespace {

class V4l2CameraTest : public testing::Test {
 protected:
  void open(const CameraOptions& asked = {}) {
    CameraOptions options = asked;
    options.device = "/dev/video7";
    opened_ = openV4l2Camera(options, driver_);
  }
  void openWell(const CameraOptions& options = {}) {
    open(options);
    ASSERT_TRUE(opened_.camera) << opened_.problem;
  }
  bool fill(std::uint8_t value, std::uint32_t sequence, std::uint32_t flags = 0, int missing_bytes = 0) {
    driver_.time_ns += 33 * ms;
    return driver_.fill(value, sequence, driver_.time_ns - 20 * ms, flags, missing_bytes);
  }
  Capture next() { return opened_.camera->next(grey_, std::chrono::milliseconds(100)); }
  void expectGrey(int value) {
    ASSERT_EQ(grey_.size(), cv::Size(64, 48));
    EXPECT_EQ(cv::norm(grey_, cv::Mat(48, 64, CV_8U, cv::Scalar(value)), cv::NORM_INF), 0);
  }
  // Nothing stays open, mapped or streaming.
  void expectReleased() {
    opened_.camera.reset();
    EXPECT_EQ(driver_.open_files, 0);
    EXPECT_TRUE(driver_.mapped.empty());
  }

  FakeDriver driver_;
  OpenedCamera opened_;
  cv::Mat grey_;
};

TEST_F(V4l2CameraTest, GivesFramesWithTheirTimeAndReleasesEverything) {
  openWell();
  EXPECT_EQ(opened_.camera->stream().format, "GREY 64 x 48, 30 frames/s");
  ASSERT_TRUE(fill(99, 0));
  const Capture capture = next();
  ASSERT_EQ(capture.event, CaptureEvent::frame) << capture.message;
  expectGrey(99);
  EXPECT_EQ(capture.frame.time_ns, driver_.time_ns - 20 * ms);
  EXPECT_EQ(capture.frame.time_meaning, TimeMeaning::exposure_start);
  EXPECT_TRUE(driver_.streaming);
  expectReleased();
  EXPECT_FALSE(driver_.streaming);
}

TEST_F(V4l2CameraTest, WritesIntoTheCallersMemory) {
  openWell();
  grey_.create(48, 64, CV_8U);
  const std::uint8_t* const memory = grey_.data;
  for (std::uint32_t i = 0; i < 20; ++i) {
    ASSERT_TRUE(fill(static_cast<std::uint8_t>(i), i));
    ASSERT_EQ(next().event, CaptureEvent::frame);
    expectGrey(static_cast<int>(i));
  }
  EXPECT_EQ(grey_.data, memory);
}

TEST_F(V4l2CameraTest, MultiPlanarDevicesAndPaddedRowsAreRead) {
  driver_.multi_planar = true;
  driver_.capabilities = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
  driver_.extra_stride = 24;
  driver_.data_offset = 16;
  openWell();
  ASSERT_TRUE(fill(5, 0));
  ASSERT_EQ(next().event, CaptureEvent::frame);
  expectGrey(5);
  expectReleased();
}

TEST_F(V4l2CameraTest, TimeRunsOutWithoutAFrame) {
  openWell();
  const std::int64_t before = driver_.time_ns;
  EXPECT_EQ(next().event, CaptureEvent::none_yet);
  EXPECT_EQ(driver_.time_ns - before, 100 * ms);
}

TEST_F(V4l2CameraTest, GapsAndWrappingNumbersAreCounted) {
  openWell();
  std::vector<std::int64_t> sequence, lost;
  for (const std::uint32_t number : {0xFFFFFFF0U, 0xFFFFFFF1U, 0xFFFFFFF5U, 3U}) {
    ASSERT_TRUE(fill(1, number));
    const Capture capture = next();
    sequence.push_back(capture.frame.sequence);
    lost.push_back(capture.frame.lost_before);
  }
  EXPECT_EQ(sequence, (std::vector<std::int64_t>{0, 1, 5, 19}));
  EXPECT_EQ(lost, (std::vector<std::int64_t>{0, 0, 3, 13}));
}

TEST_F(V4l2CameraTest, TheNewestFrameWinsAndTheOthersAreCounted) {
  openWell();
  for (std::uint32_t i = 0; i < 3; ++i) ASSERT_TRUE(fill(static_cast<std::uint8_t>(10 + i), 2 * i));
  const Capture capture = next();
  expectGrey(12);
  EXPECT_EQ(capture.frame.sequence, 4);
  EXPECT_EQ(capture.frame.passed_over_before, 2);
  EXPECT_EQ(capture.frame.lost_before, 2);
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_TRUE(fill(1, 5 + i)) << "a buffer was not given back";
}

TEST_F(V4l2CameraTest, EveryFrameIsGivenWhereThatIsAskedFor) {
  CameraOptions options;
  options.every_frame = true;
  openWell(options);
  for (std::uint32_t i = 0; i < 3; ++i) ASSERT_TRUE(fill(static_cast<std::uint8_t>(10 + i), i));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(next().frame.sequence, i);
    expectGrey(10 + i);
  }
}

TEST_F(V4l2CameraTest, BrokenAndShortBuffersAreDamagedFramesAndTheStreamGoesOn) {
  openWell();
  ASSERT_TRUE(fill(1, 0, V4L2_BUF_FLAG_ERROR));
  Capture capture = next();
  EXPECT_EQ(capture.event, CaptureEvent::damaged_frame);
  EXPECT_NE(capture.message.find("broken"), std::string::npos);
  for (const int missing : {1, 64 * 48}) {
    ASSERT_TRUE(fill(1, 1, 0, missing));
    capture = next();
    EXPECT_EQ(capture.event, CaptureEvent::damaged_frame);
    EXPECT_NE(capture.message.find("cut off"), std::string::npos) << capture.message;
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    ASSERT_TRUE(fill(1, 2 + i)) << "a buffer was not given back";
    EXPECT_EQ(next().event, CaptureEvent::frame);
  }
}

// With the rest of the driver's buffer left as it was.
TEST_F(V4l2CameraTest, AJpegIsGivenAsItCameWhereThatIsAskedFor) {
  driver_.formats = {{v4l2_fourcc('M', 'J', 'P', 'G'), {{64, 48, {30}}}}};
  openWell();
  cv::Mat shown(48, 64, CV_8U, cv::Scalar(90));
  shown.colRange(20, 40).setTo(200);
  const std::vector<unsigned char> sent = madeJpeg(shown);
  std::vector<unsigned char> buffer = sent;
  buffer.resize(64 * 48 * 2, 0xEE);
  const auto fillWith = [&](std::uint32_t sequence, std::size_t size) {
    driver_.time_ns += 33 * ms;
    const auto missing = static_cast<int>(buffer.size() - size);
    ASSERT_TRUE(driver_.fill(buffer.data(), sequence, driver_.time_ns, 0, missing));
  };
  fillWith(0, sent.size());
  Capture capture = next();
  ASSERT_EQ(capture.event, CaptureEvent::frame) << capture.message;
  EXPECT_EQ(capture.jpeg, nullptr) << "nobody asked";

  opened_.camera->keepJpeg(true);
  fillWith(1, sent.size());
  capture = next();
  ASSERT_EQ(capture.event, CaptureEvent::frame) << capture.message;
  ASSERT_TRUE(capture.jpeg);
  EXPECT_EQ(*capture.jpeg, sent);
  EXPECT_EQ(cv::norm(grey_, decodedAsLive(*capture.jpeg, grey_.size()), cv::NORM_INF), 0);

  fillWith(2, sent.size() / 2);
  capture = next();
  EXPECT_EQ(capture.event, CaptureEvent::damaged_frame);
  EXPECT_EQ(capture.jpeg, nullptr);
}

TEST_F(V4l2CameraTest, SignalsInterruptNothing) {
  for (const unsigned long request : {VIDIOC_QUERYCAP, VIDIOC_S_FMT, VIDIOC_STREAMON, VIDIOC_DQBUF, VIDIOC_QBUF}) {
    driver_.failures[request] = {EINTR, EINTR};
  }
  openWell();
  driver_.wait_failures = {-EINTR};
  ASSERT_TRUE(fill(3, 0));
  EXPECT_EQ(next().event, CaptureEvent::frame);
  expectGrey(3);
}

TEST_F(V4l2CameraTest, ABufferThatAnotherTookIsWaitedFor) {
  openWell();
  driver_.failures[VIDIOC_DQBUF] = {EAGAIN};
  ASSERT_TRUE(fill(3, 0));
  EXPECT_EQ(next().event, CaptureEvent::frame);
}

TEST_F(V4l2CameraTest, UnpluggingIsNoticedAtOnce) {
  openWell();
  ASSERT_TRUE(fill(3, 0));
  EXPECT_EQ(next().event, CaptureEvent::frame);
  driver_.plugged = false;
  const std::int64_t before = driver_.time_ns;
  const Capture capture = next();
  EXPECT_EQ(capture.event, CaptureEvent::interrupted);
  EXPECT_NE(capture.message.find("not plugged in"), std::string::npos) << capture.message;
  EXPECT_NE(capture.message.find("/dev/video7"), std::string::npos) << capture.message;
  EXPECT_EQ(driver_.time_ns, before);
  expectReleased();
}

TEST_F(V4l2CameraTest, ErrorsOfTheStreamInterruptIt) {
  for (const int error : {EIO, ENODEV, EPIPE, EINVAL}) {
    openWell();
    ASSERT_TRUE(fill(3, 0));
    driver_.failures[VIDIOC_DQBUF] = {error};
    EXPECT_EQ(next().event, CaptureEvent::interrupted) << error;
    expectReleased();
  }
  openWell();
  ASSERT_TRUE(fill(3, 0));
  driver_.failures[VIDIOC_QBUF] = {EIO};
  EXPECT_EQ(next().event, CaptureEvent::interrupted);
}

// Else poll would answer at once, for ever, and nothing would come.
TEST_F(V4l2CameraTest, AnErrorThatOnlyPollTellsInterruptsTheStream) {
  openWell();
  driver_.wait_failures = {POLLERR};
  EXPECT_EQ(next().event, CaptureEvent::interrupted);
  openWell();
  driver_.wait_failures = {-ENOMEM};
  EXPECT_EQ(next().event, CaptureEvent::interrupted);
}

TEST_F(V4l2CameraTest, WhatFailsInOpeningIsToldAndNothingIsLeftOpen) {
  const std::vector<std::pair<unsigned long, bool>> requests{{VIDIOC_QUERYCAP, true}, {VIDIOC_G_FMT, true},
                                                             {VIDIOC_REQBUFS, true},  {VIDIOC_QUERYBUF, true},
                                                             {VIDIOC_QBUF, true},     {VIDIOC_STREAMON, true}};
  for (const auto& [request, may_heal] : requests) {
    driver_.failures.clear();
    driver_.failures[request] = {EIO};
    open();
    EXPECT_FALSE(opened_.camera) << request;
    EXPECT_EQ(opened_.problem.rfind("/dev/video7: ", 0), 0U) << opened_.problem;
    EXPECT_EQ(opened_.may_heal, may_heal) << opened_.problem;
    expectReleased();
  }
  driver_.failures.clear();
  driver_.map_failure = ENOMEM;
  open();
  EXPECT_FALSE(opened_.camera);
  expectReleased();
}

TEST_F(V4l2CameraTest, AStreamThatDoesNotStartMayStartLater) {
  driver_.failures[VIDIOC_STREAMON] = {EINVAL};
  open();
  EXPECT_FALSE(opened_.camera);
  EXPECT_TRUE(opened_.may_heal);
  openWell();
}

TEST_F(V4l2CameraTest, WhatCannotBeOpenedIsToldWithWhatToDo) {
  const auto problemOf = [&](int error) -> const OpenedCamera& {
    driver_.open_failure = error;
    open();
    return opened_;
  };
  EXPECT_NE(problemOf(EBUSY).problem.find("another program"), std::string::npos);
  EXPECT_TRUE(problemOf(EBUSY).may_heal);
  EXPECT_NE(problemOf(ENOENT).problem.find("not plugged in"), std::string::npos);
  EXPECT_TRUE(problemOf(ENOENT).may_heal);
  EXPECT_NE(problemOf(EACCES).problem.find("group video"), std::string::npos);
  EXPECT_FALSE(problemOf(EACCES).may_heal);
  driver_.open_failure = 0;
  driver_.capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  open();
  EXPECT_NE(opened_.problem.find("is no camera"), std::string::npos);
  driver_.capabilities = V4L2_CAP_VIDEO_CAPTURE;
  open();
  EXPECT_NE(opened_.problem.find("does not stream"), std::string::npos);
}

TEST_F(V4l2CameraTest, AFixedExposureGivesTheMiddleOfTheExposure) {
  driver_.controls[V4L2_CID_EXPOSURE_AUTO] = {
      "Auto Exposure", V4L2_CTRL_TYPE_MENU, 0, 3, 1, 3, {{1, "Manual Mode"}, {3, "Aperture Priority Mode"}}};
  driver_.controls[V4L2_CID_EXPOSURE_ABSOLUTE] = {
      "Exposure Time, Absolute", V4L2_CTRL_TYPE_INTEGER, 1, 5000, 1, 157, {}};
  CameraOptions options;
  openWell(options);
  ASSERT_TRUE(fill(1, 0));
  EXPECT_EQ(next().frame.time_meaning, TimeMeaning::exposure_start);
  expectReleased();

  options.controls = {{"exposure", "8"}};
  openWell(options);
  ASSERT_TRUE(fill(1, 0));
  Capture capture = next();
  EXPECT_EQ(capture.frame.time_meaning, TimeMeaning::exposure_middle);
  EXPECT_EQ(capture.frame.time_ns, driver_.time_ns - 20 * ms + 4 * ms);
  driver_.buffer_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_EOF;
  ASSERT_TRUE(fill(1, 1));
  EXPECT_EQ(next().frame.time_ns, driver_.time_ns - 20 * ms - 4 * ms);
}

// Of a driver that tells the readout itself, too: only the calibration says whether the shutter is a rolling one.
TEST_F(V4l2CameraTest, TheCalibrationsReadoutGivesTheTimeOfTheMiddleRow) {
  driver_.own_numbers = {{V4L2_CID_PIXEL_RATE, 1'000'000}, {V4L2_CID_HBLANK, 136}};
  CameraOptions options;
  for (const double readout_s : {0.0, 0.012, -0.012}) {
    options.readout_s = readout_s;
    openWell(options);
    const std::int64_t half_ns = readout_s == 0 ? 0 : 6 * ms;
    driver_.buffer_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
    ASSERT_TRUE(fill(1, 0));
    EXPECT_EQ(next().frame.time_ns, driver_.time_ns - 20 * ms + half_ns);
    driver_.buffer_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_EOF;
    ASSERT_TRUE(fill(1, 1));
    EXPECT_EQ(next().frame.time_ns, driver_.time_ns - 20 * ms - half_ns);
    expectReleased();
  }
}

TEST_F(V4l2CameraTest, ALimitedExposureIsRegulatedBelowItsLimit) {
  driver_.controls[V4L2_CID_EXPOSURE_AUTO] = {
      "Auto Exposure", V4L2_CTRL_TYPE_MENU, 0, 3, 1, 3, {{1, "Manual Mode"}, {3, "Aperture Priority Mode"}}};
  driver_.controls[V4L2_CID_EXPOSURE_ABSOLUTE] = {
      "Exposure Time, Absolute", V4L2_CTRL_TYPE_INTEGER, 1, 5000, 1, 157, {}};
  driver_.controls[V4L2_CID_GAIN] = {"Gain", V4L2_CTRL_TYPE_INTEGER, 0, 160, 1, 0, {}};
  CameraOptions options;
  options.longest_exposure_ms = 10;
  openWell(options);
  const auto value = [&](std::uint32_t id) { return driver_.controls.at(id).value; };
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
  std::uint32_t sequence = 0;
  const auto run = [&](int grey) {
    for (int i = 0; i < 200; ++i) {
      ASSERT_TRUE(fill(static_cast<std::uint8_t>(grey), sequence++));
      ASSERT_EQ(next().event, CaptureEvent::frame);
      ASSERT_LE(value(V4L2_CID_EXPOSURE_ABSOLUTE), 100);
    }
  };
  run(5);  // as dark as it may be, the limit holds and gain helps
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_ABSOLUTE), 100);
  EXPECT_EQ(value(V4L2_CID_GAIN), 160);
  run(110);
  EXPECT_EQ(value(V4L2_CID_GAIN), 160);
  run(255);
  EXPECT_EQ(value(V4L2_CID_GAIN), 0);
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_ABSOLUTE), 1);
  ASSERT_TRUE(fill(110, sequence));
  EXPECT_EQ(next().frame.time_ns, driver_.time_ns - 20 * ms + 50'000);  // half of 0.1 ms after the start
}

TEST_F(V4l2CameraTest, AnExposureThatCannotBeLimitedIsTold) {
  CameraOptions options;
  options.longest_exposure_ms = 10;
  openWell(options);
  EXPECT_NE(opened_.camera->stream().format.find("without limit"), std::string::npos);
}

TEST_F(V4l2CameraTest, StampsOfAnotherClockAreReplacedByTheTimeOfArrival) {
  openWell();
  driver_.buffer_flags = V4L2_BUF_FLAG_TIMESTAMP_COPY;
  ASSERT_TRUE(fill(1, 0));
  Capture capture = next();
  EXPECT_EQ(capture.frame.time_meaning, TimeMeaning::arrival);
  EXPECT_EQ(capture.frame.time_ns, driver_.time_ns);
  driver_.buffer_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  ASSERT_TRUE(driver_.fill(1, 1, 9'000'000'000'000'000'000));  // as after a wrap
  EXPECT_EQ(next().frame.time_meaning, TimeMeaning::arrival);
  driver_.buffer_flags = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN;
  ASSERT_TRUE(fill(1, 2));
  EXPECT_EQ(next().frame.time_meaning, TimeMeaning::exposure_end);
}

}  // namespace
}  // namespace edgeslam
