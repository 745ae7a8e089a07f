// What feeds the watchdog, and what the log is told. What is published is tested on the real program.
#include "app/run_publisher.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <functional>
#include <sstream>

#include "unit/dataset/temporary_folder.h"
#include "unit/lcm/made_frames.h"

namespace edgeslam {
namespace {

Camera smallCamera() {
  Camera camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 300;
  camera.cx = 160;
  camera.cy = 120;
  return camera;
}

class RunPublisherTest : public testing::Test {
 protected:
  RunPublisherTest() : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = folder_.path("notify");
    path.copy(address.sun_path, sizeof(address.sun_path) - 1);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
    setenv("WATCHDOG_USEC", "2000000", 1);
    unsetenv("WATCHDOG_PID");
    PublishingSetup setup;
    setup.lcm.url = "memq://";
    setup.camera = smallCamera();
    run_ = std::make_unique<LiveRun>(setup.camera, Settings(), LiveOptions(), LiveObserver(), nullptr);
    publisher_ = std::make_unique<RunPublisher>(setup, link_, log_);
    publisher_->begin(*run_, nullptr, RunStart::new_map);
  }
  ~RunPublisherTest() override {
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
    close(socket_);
  }

  bool isFed() const {
    bool fed = false;
    std::array<char, 4096> buffer{};
    for (ssize_t bytes = 0; (bytes = recv(socket_, buffer.data(), buffer.size(), 0)) >= 0;) {
      fed = fed || std::string(buffer.data(), static_cast<std::size_t>(bytes)) == "WATCHDOG=1";
    }
    return fed;
  }

  TemporaryFolder folder_;
  int socket_;
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
  EXPECT_EQ(said_.str(), "edgeslam: no file is configured for the map (map.file)\n");
}

TEST_F(RunPublisherTest, TotalsGoOnOverRuns) {
  for (int i = 0; i < 3; ++i) run_->handOver();
  link_.lost(2);
  publisher_->frame(frameWithoutPose(0, TrackingState::predicted, "torn"), "torn");
  publisher_->end();
  LiveRun next(smallCamera(), Settings(), LiveOptions(), LiveObserver(), nullptr);
  publisher_->begin(next, nullptr, RunStart::new_map);
  next.handOver();
  const PublisherStatus status = publisher_->status();
  EXPECT_EQ(status.frames_captured, 4);
  EXPECT_EQ(status.frames_dropped, 2);
  EXPECT_EQ(status.frames_unreadable, 1);
  EXPECT_FALSE(status.recording);
  publisher_->end();
}

}  // namespace
}  // namespace edgeslam
