#include "app/camera_recording.h"

#include <gtest/gtest.h>

#include <deque>
#include <opencv2/core.hpp>

#include "frames/frame_source.h"
#include "recording/open_frame_source.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

constexpr std::int64_t ms = 1'000'000;

class ScriptedCamera : public LiveCamera {
 public:
  Capture next(cv::Mat& grey, std::chrono::nanoseconds) override {
    if (script.empty()) return {CaptureEvent::ended, {}, ""};
    const Capture capture = script.front();
    script.pop_front();
    grey = cv::Mat(12, 16, CV_8U, cv::Scalar(static_cast<double>(capture.frame.sequence % 256)));
    return capture;
  }
  const StreamDescription& stream() const override { return stream_; }
  void frames(std::int64_t first, std::int64_t count) {
    for (std::int64_t i = first; i < first + count; ++i) {
      Capture capture{CaptureEvent::frame, {}, ""};
      capture.frame.sequence = i;
      capture.frame.time_ns = 5'000'000'123 + i * 33 * ms;
      capture.frame.time_meaning = TimeMeaning::exposure_start;
      script.push_back(capture);
    }
  }

  std::deque<Capture> script;

 private:
  StreamDescription stream_{"scripted", "GREY", 16, 12, 33 * ms};
};

class CameraRecordingTest : public testing::Test {
 protected:
  CameraRecordingResult record(const CameraRecordingLimits& limits = {0, 0, 1000}) {
    FrameFolderWriter writer(output_, calibration_, "scripted", 0);
    return recordCamera(
        camera_, writer, limits, [this] { return stop_; },
        [this](const std::string& message) { told_.push_back(message); },
        [this](const CameraRecordingCounts& counts) { stop_ = stop_ || counts.written >= stop_after_; });
  }

  TemporaryFolder folder_;
  std::string output_ = folder_.path("recording");
  std::optional<Camera> calibration_ = Camera{CameraModel::pinhole_radial_tangential, 16, 12, 10, 10, 8, 6, {}};
  ScriptedCamera camera_;
  std::vector<std::string> told_;
  bool stop_ = false;
  std::int64_t stop_after_ = 1'000'000;
};

TEST_F(CameraRecordingTest, WhatWasRecordedReadsBackWithItsTimesAndCalibration) {
  camera_.frames(0, 20);
  const CameraRecordingResult result = record();
  EXPECT_EQ(result.problem, "");
  EXPECT_EQ(result.counts.written, 20);
  EXPECT_EQ(result.counts.duration_ns, 19 * 33 * ms);
  const std::unique_ptr<FrameSource> source = openFrameSource(output_);
  EXPECT_EQ(source->size(), 20);
  EXPECT_EQ(source->camera(), calibration_);
  for (int i = 0; i < 20; ++i) {
    const std::optional<Frame> frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->problem, "");
    EXPECT_EQ(frame->time_ns, 5'000'000'123 + i * 33 * ms);
    EXPECT_EQ(cv::norm(frame->grey, cv::Mat(12, 16, CV_8U, cv::Scalar(i)), cv::NORM_INF), 0);
  }
}

TEST_F(CameraRecordingTest, LimitsAndAStopEndIt) {
  camera_.frames(0, 100);
  EXPECT_EQ(record({7, 0, 1000}).counts.written, 7);
  output_ = folder_.path("second");
  EXPECT_EQ(record({0, 330 * ms, 1000}).counts.written, 10);
  output_ = folder_.path("third");
  stop_after_ = 5;
  EXPECT_EQ(record().counts.written, 5);
}

TEST_F(CameraRecordingTest, TroublesAreToldAndCounted) {
  camera_.frames(0, 3);
  camera_.script.push_back({CaptureEvent::damaged_frame, {}, "torn"});
  camera_.script.push_back({CaptureEvent::damaged_frame, {}, "torn"});
  camera_.script.push_back({CaptureEvent::interrupted, {}, "unplugged"});
  camera_.script.push_back({CaptureEvent::none_yet, {}, ""});
  camera_.frames(9, 2);
  camera_.script[camera_.script.size() - 2].frame.after_interruption = true;
  camera_.script.back().frame.lost_before = 4;
  const CameraRecordingCounts counts = record().counts;
  EXPECT_EQ(counts.written, 5);
  EXPECT_EQ(counts.damaged, 2);
  EXPECT_EQ(counts.interruptions, 1);
  EXPECT_EQ(counts.lost_by_driver, 4);
  ASSERT_EQ(told_.size(), 3U);
  EXPECT_EQ(told_[0].rfind("torn", 0), 0U);
  EXPECT_EQ(told_[1], "unplugged");
  EXPECT_EQ(told_[2], "the camera is back");
}

TEST_F(CameraRecordingTest, ADiskThatTakesNoMoreEndsIt) {
  camera_.frames(0, 100);
  camera_.script[30].frame.time_ns = 1;  // stands for any problem of the writer
  const CameraRecordingResult result = record();
  EXPECT_NE(result.problem, "");
  EXPECT_EQ(result.counts.written, 30);
  EXPECT_EQ(openFrameSource(output_)->size(), 30);
}

}  // namespace
}  // namespace edgeslam
