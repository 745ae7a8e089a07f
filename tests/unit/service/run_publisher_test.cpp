// What feeds the watchdog, and what the log is told. What is published is tested on the real program.
#include "service/run_publisher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <sstream>

#include "unit/lcm/made_frames.h"
#include "unit/service/made_service.h"
#include "unit/service/service_manager.h"

namespace edgeslam {
namespace {

class RunPublisherTest : public testing::Test {
 protected:
  RunPublisherTest() {
    PublishingSetup setup;
    setup.lcm.url = "memq://";
    setup.camera = smallCamera();
    run_ = std::make_unique<LiveRun>(setup.camera, Settings(), LiveOptions(), LiveObserver(), nullptr);
    publisher_ = std::make_unique<RunPublisher>(setup, link_, log_);
    publisher_->begin(*run_, nullptr, RunStart::new_map);
  }
  bool isFed() {
    EXPECT_TRUE(publisher_->service().waitUntilTold());
    const std::vector<std::string> told = manager_.told();
    return std::count(told.begin(), told.end(), "WATCHDOG=1") > 0;
  }

  ServiceManager manager_;
  std::ostringstream said_;
  EventLog log_{said_};
  CaptureLink link_;
  std::unique_ptr<LiveRun> run_;
  std::unique_ptr<RunPublisher> publisher_;
};

TEST_F(RunPublisherTest, TimeAloneDoesNotFeedTheWatchdog) {
  for (int i = 0; i < 5; ++i) publisher_->tick();
  EXPECT_FALSE(isFed()) << "a stalled pipeline is restarted";
}

TEST_F(RunPublisherTest, AFrameFeedsItWhateverBecameOfItsPose) {
  publisher_->frame(frameWithoutPose(0, TrackingState::lost, "covered"), "");
  EXPECT_TRUE(isFed());
}

TEST_F(RunPublisherTest, WaitingForACameraFeedsItOnlyWhileCaptureIsAlive) {
  link_.waited();
  publisher_->tick();
  EXPECT_TRUE(isFed());
  publisher_->tick();
  EXPECT_FALSE(isFed());
}

TEST_F(RunPublisherTest, ASignalForTheMapWithoutAFileIsToldOnce) {
  link_.askForMapToBeSaved();
  publisher_->tick();
  publisher_->tick();
  ASSERT_TRUE(log_.waitUntilOut());
  EXPECT_EQ(said_.str(), "edgeslam: no file is configured for the map (map.file)\n");
}

TEST_F(RunPublisherTest, AChangeOfTheWorldIsToldAndCounted) {
  FrameResult frame = measuredFrame(0, Pose());
  frame.world = 0;
  publisher_->frame(frame, "");
  publisher_->frame(frameWithoutPose(1, TrackingState::lost, "covered"), "");
  frame.index = 2, frame.world = 1;
  publisher_->frame(frame, "");
  ASSERT_TRUE(log_.waitUntilOut());
  EXPECT_EQ(said_.str(), "edgeslam: frame 2: map 1 is begun beside map 0: lost there, covered\n");
  EXPECT_EQ(publisher_->status().worlds, 2);
}

TEST_F(RunPublisherTest, TotalsGoOnOverRuns) {
  for (int i = 0; i < 3; ++i) run_->handOver();
  link_.lost(2);
  publisher_->frame(frameWithoutPose(0, TrackingState::predicted, "torn"), "torn");
  publisher_->end(/*is_last=*/false);
  LiveRun next(smallCamera(), Settings(), LiveOptions(), LiveObserver(), nullptr);
  publisher_->begin(next, nullptr, RunStart::new_map);
  next.handOver();
  const PublisherStatus status = publisher_->status();
  EXPECT_EQ(status.frames_captured, 4);
  EXPECT_EQ(status.frames_dropped, 2);
  EXPECT_EQ(status.frames_unreadable, 1);
  EXPECT_FALSE(status.recording);
  publisher_->end(/*is_last=*/true);
}

}  // namespace
}  // namespace edgeslam
