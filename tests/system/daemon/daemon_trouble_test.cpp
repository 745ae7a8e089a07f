// The daemon where something is missing: subscribers, network, camera, disk.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <array>

#include "system/daemon/daemon_fixture.h"
#include "system/program.h"

namespace edgeslam {
namespace {

class DaemonTrouble : public DaemonTest {};

// As the service manager hears it.
class Notifications {
 public:
  explicit Notifications(const std::string& path) : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof(address.sun_path) - 1);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
    setenv("WATCHDOG_USEC", "2000000", 1);
    unsetenv("WATCHDOG_PID");
  }
  ~Notifications() {
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
    close(socket_);
  }
  Notifications(const Notifications&) = delete;
  Notifications& operator=(const Notifications&) = delete;

  // So often since the start.
  bool hears(const std::string& text, int times = 1) {
    return comesTrue([&] {
      std::array<char, 4096> buffer{};
      for (ssize_t bytes = 0; (bytes = recv(socket_, buffer.data(), buffer.size(), 0)) >= 0;) {
        all_ += std::string(buffer.data(), static_cast<std::size_t>(bytes)) + "\n";
      }
      int count = 0;
      for (std::size_t at = all_.find(text); at != std::string::npos; at = all_.find(text, at + 1)) ++count;
      return count >= times;
    });
  }
  const std::string& all() const { return all_; }

 private:
  int socket_;
  std::string all_;
};

TEST_F(DaemonTrouble, WithoutANetworkTheMapComesToStandAllTheSame) {
  ASSERT_TRUE(switchNetworkOff());
  const std::string map = folder_.path("robot.map");
  const auto daemon = startOn(parlour_, {"--map-out", map});
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
  EXPECT_NE(daemon->said().find("ip route add"), std::string::npos) << daemon->said();
  EXPECT_TRUE(std::filesystem::exists(map)) << daemon->said();
  EXPECT_LT(daemon->times("\n"), 40) << "no flood: " << daemon->said();
}

TEST_F(DaemonTrouble, ACameraThatIsNotThereIsWaitedForAndTold) {
  Notifications notifications(folder_.path("notify"));
  const auto daemon = start({"run", "--config",
                             configure("camera: {calibration: " + parlour_ +
                                       "/camera.yaml}\n"
                                       "capture: {device: /dev/v4l/by-id/none}\n")});
  EXPECT_TRUE(notifications.hears("READY=1")) << daemon->said();
  EXPECT_TRUE(notifications.hears("STATUS=no camera: /dev/v4l/by-id/none"));
  EXPECT_TRUE(notifications.hears("WATCHDOG=1", 3)) << "a restart would not help";
  ASSERT_TRUE(robot_->hears([](const Heard& heard) { return heard.statuses.size() >= 2; }));
  const status_t status = robot_->heard().statuses.back();
  EXPECT_EQ(status.state, state_t::LOST);
  EXPECT_NE(status.reason.find("/dev/v4l/by-id/none"), std::string::npos);
  EXPECT_EQ(daemon->times("/dev/v4l/by-id/none"), 1) << "told once: " << daemon->said();
  daemon->send(SIGTERM);
  EXPECT_TRUE(notifications.hears("STOPPING=1"));
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
}

TEST_F(DaemonTrouble, FramesFeedTheWatchdog) {
  Notifications notifications(folder_.path("notify"));
  const auto daemon = startOn(parlour_);
  EXPECT_TRUE(notifications.hears("READY=1"));
  EXPECT_TRUE(notifications.hears("WATCHDOG=1", 4)) << notifications.all();
  EXPECT_TRUE(notifications.hears("STATUS=tracking, ")) << notifications.all();
  EXPECT_TRUE(notifications.hears("STOPPING=1"));
  EXPECT_EQ(daemon->exitCode(), 0);
}

TEST_F(DaemonTrouble, ARecordingThatMayTakeNoMoreEndsAndPosesGoOn) {
  const std::string recordings = folder_.path("recordings");
  const auto daemon = startOn(parlour_, {"--config", configure("recording: {folder: " + recordings +
                                                               ", from_start: true, most_megabytes: 1}\n")});
  ASSERT_TRUE(daemon->says("the budget of 1048576 bytes is used up")) << daemon->said();
  const std::size_t before = robot_->heard().states.size();
  ASSERT_TRUE(robot_->hears([&](const Heard& heard) { return heard.states.size() > before + 60; })) << daemon->said();
  EXPECT_FALSE(robot_->heard().statuses.back().recording);
  EXPECT_EQ(daemon->times("used up"), 1) << "told once: " << daemon->said();
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
}

TEST_F(DaemonTrouble, OnAFullDiskPosesGoOnAndTheMapBeforeStays) {
  const std::string disk = folder_.path("disk");
  std::filesystem::create_directory(disk);
  const std::string mount = "mount -t tmpfs -o size=400k none " + disk;
  if (!runsWell("unshare -rm sh -c '" + mount + "'")) GTEST_SKIP() << "no file system can be mounted here";
  const std::string configuration = configure("recording: {folder: " + disk + "/recordings, from_start: true}\n");
  const std::string map = disk + "/robot.map";
  BackgroundProcess daemon({"unshare", "-rm", "sh", "-c",
                            mount + "; echo before > " + map + "; " EDGESLAM_PROGRAM " run --source " + parlour_ +
                                " --config " + configuration + " --map-out " + map + "; echo code $?; cat " + map});
  ASSERT_TRUE(daemon.says("bytes free")) << daemon.said();
  ASSERT_TRUE(isTracking()) << "poses go on: " << daemon.said();
  const std::size_t before = robot_->heard().states.size();
  ASSERT_TRUE(robot_->hears([&](const Heard& heard) { return heard.states.size() > before + 60; })) << daemon.said();
  EXPECT_TRUE(daemon.says("code 2")) << daemon.said();
  EXPECT_EQ(daemon.times("No space left on device"), 1) << daemon.said();
  EXPECT_TRUE(daemon.says("\nbefore\n")) << "the map that was there: " << daemon.said();
}

TEST_F(DaemonTrouble, WhatCannotWorkIsOneLine) {
  const std::string bad_url = folder_.write("url.yaml", "lcm: {url: 'udpm://no'}\n");
  const std::string misspelt = folder_.write("misspelt.yaml", "lcm: {\n  chanel: A}\n");
  const std::vector<std::pair<Options, std::string>> wrong{
      {{"run"}, "no calibration of the camera"},
      {{"run", "--source", folder_.path("nothing")}, "nothing"},
      {{"run", "--source", parlour_, "--map-in", folder_.path("no.map")}, "no.map: no such file"},
      {{"run", "--source", parlour_, "--map-out", folder_.path("no/robot.map")}, "is no folder"},
      {{"run", "--source", parlour_, "--config", bad_url}, "url.yaml:1: lcm"},
      {{"run", "--source", parlour_, "--config", misspelt}, "misspelt.yaml:2: lcm.chanel is not a key"},
      {{"replay", parlour_, "--lcm"}, "--realtime"},
  };
  for (const auto& [options, message] : wrong) {
    const Outcome outcome = runProgram(options);
    EXPECT_EQ(outcome.exit_code, 2) << message;
    ASSERT_EQ(outcome.failures().size(), 1U) << outcome.messages;
    EXPECT_NE(outcome.failures()[0].find(message), std::string::npos) << outcome.messages;
  }
}

}  // namespace
}  // namespace edgeslam
