#include "drivers/replay/replay_camera.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <vector>

namespace edgeslam {
namespace {

constexpr std::int64_t ms = 1'000'000;

class ListSource : public FrameSource {
 public:
  explicit ListSource(std::vector<Frame> frames) : frames_(std::move(frames)) {}
  std::optional<Frame> next() override {
    if (at_ == frames_.size()) return std::nullopt;
    return frames_[at_++];
  }
  std::int64_t size() const override { return static_cast<std::int64_t>(frames_.size()); }
  std::string kind() const override { return "list"; }
  std::optional<Camera> camera() const override { return std::nullopt; }
  std::string groundTruthPath() const override { return ""; }

 private:
  std::vector<Frame> frames_;
  std::size_t at_ = 0;
};

Frame frame(std::int64_t index, std::int64_t time_ns, const std::string& problem = "") {
  return {index, time_ns, problem.empty() ? cv::Mat(6, 8, CV_8U, cv::Scalar(double(index))) : cv::Mat(), problem};
}

class ReplayCameraTest : public testing::Test {
 protected:
  void open(std::vector<Frame> frames, bool by_time_stamps, cv::Size size = {}) {
    opened_ = openReplayCamera(
        std::make_unique<ListSource>(std::move(frames)), "list", size,
        {by_time_stamps, [this] { return now_ns_; }, [this](std::int64_t duration_ns) { now_ns_ += duration_ns; }});
  }
  Capture next() { return opened_.camera->next(grey_, std::chrono::milliseconds(100)); }

  std::int64_t now_ns_ = 7000 * ms;
  OpenedCamera opened_;
  cv::Mat grey_;
};

TEST_F(ReplayCameraTest, FramesComeAtTheirTimes) {
  open({frame(0, 0), frame(1, 40 * ms), frame(2, 300 * ms)}, true);
  ASSERT_TRUE(opened_.camera);
  EXPECT_EQ(opened_.camera->stream().frame_interval_ns, 40 * ms);
  EXPECT_EQ(next().frame.sequence, 0);
  EXPECT_EQ(next().frame.time_ns, 40 * ms);
  EXPECT_EQ(now_ns_, 7040 * ms);
  EXPECT_EQ(next().event, CaptureEvent::none_yet);
  EXPECT_EQ(next().event, CaptureEvent::none_yet);
  EXPECT_EQ(now_ns_, 7240 * ms);
  EXPECT_EQ(next().frame.sequence, 2);
  EXPECT_EQ(now_ns_, 7300 * ms);
  EXPECT_EQ(grey_.at<std::uint8_t>(3, 3), 2);
  EXPECT_EQ(next().event, CaptureEvent::ended);
  EXPECT_EQ(next().event, CaptureEvent::ended);
}

TEST_F(ReplayCameraTest, WithoutPaceNothingWaitsAndNothingIsLeftOut) {
  std::vector<Frame> frames;
  for (int i = 0; i < 50; ++i) frames.push_back(frame(i, 1000 * ms * i));
  open(frames, false);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(next().frame.sequence, i);
  EXPECT_EQ(now_ns_, 7000 * ms);
}

TEST_F(ReplayCameraTest, ALateCallerStillGetsEveryFrame) {
  open({frame(0, 0), frame(1, 30 * ms), frame(2, 60 * ms)}, true);
  next();
  now_ns_ += 5000 * ms;
  const std::int64_t late_ns = now_ns_;
  EXPECT_EQ(next().frame.sequence, 1);
  EXPECT_EQ(next().frame.sequence, 2);
  EXPECT_EQ(now_ns_, late_ns);
}

TEST_F(ReplayCameraTest, UnreadableFramesAndThoseOfAnotherSizeAreDamagedAndGapsAreCounted) {
  Frame wide = frame(5, 50 * ms);
  wide.grey = cv::Mat(6, 9, CV_8U, cv::Scalar(0));
  open({frame(0, 0, "torn"), frame(1, 10 * ms), frame(4, 40 * ms), wide}, false);
  EXPECT_EQ(next().message, "torn");
  EXPECT_EQ(next().event, CaptureEvent::frame);
  EXPECT_EQ(next().frame.lost_before, 2);
  const Capture other = next();
  EXPECT_EQ(other.event, CaptureEvent::damaged_frame);
  EXPECT_NE(other.message.find("9 x 6"), std::string::npos) << other.message;
}

TEST_F(ReplayCameraTest, WithoutAnyReadableFrameThereIsNoCamera) {
  open({}, false);
  EXPECT_FALSE(opened_.camera);
  open({frame(0, 0, "torn")}, false);
  EXPECT_NE(opened_.problem.find("torn"), std::string::npos);
}

}  // namespace
}  // namespace edgeslam
