// What the robot gets from the daemon and from a replay at real time, and how they end.
#include <gtest/gtest.h>

#include <chrono>

#include "frames/frame_source.h"
#include "map/saved_map.h"
#include "recording/open_frame_source.h"
#include "system/daemon/daemon_fixture.h"

namespace edgeslam {
namespace {

// Every frame of `frames` is told of, in order, and the poses are true.
void expectAllFrames(const Heard& heard, std::int64_t frames) {
  ASSERT_FALSE(heard.statuses.empty());
  const status_t& last = heard.statuses.back();
  EXPECT_EQ(last.frames_captured, frames);
  EXPECT_EQ(static_cast<std::int64_t>(heard.states.size()), frames - last.frames_dropped);
  EXPECT_EQ(heard.updates.size(), heard.states.size());
  for (std::size_t i = 1; i < heard.states.size(); ++i) {
    ASSERT_EQ(heard.states[i].sequence, heard.states[i - 1].sequence + 1);
    ASSERT_GT(heard.states[i].frame, heard.states[i - 1].frame);
    ASSERT_GT(heard.states[i].utime, heard.states[i - 1].utime);
  }
  EXPECT_EQ(heard.poses.size(), trajectoryOf(heard.states).size());
  EXPECT_EQ(last.messages_not_sent, 0);
  // One a second, whatever the load: as many as seconds went by.
  EXPECT_NEAR(static_cast<double>(heard.statuses.size()), 1e-3 * static_cast<double>(last.uptime_ms), 3);
  EXPECT_GT(last.keyframes, 3);
  EXPECT_GT(last.points, 100);
  EXPECT_FALSE(heard.map_parts.empty());
  ASSERT_FALSE(heard.line_parts.empty());
  EXPECT_GT(heard.line_parts.back().lines_in_map, 0);
}

TEST_F(DaemonTest, EveryFrameIsPublishedUntilTheRecordingEndsAndTheMapIsWritten) {
  const std::string map = folder_.path("robot.map");
  const auto daemon = startOn(parlour_, {"--map-out", map});
  ASSERT_EQ(daemon->exitCode(), 0) << daemon->said();
  ASSERT_TRUE(robot_->hearsStatus([](const status_t& status) { return status.frames_captured == 300; }));
  const Heard heard = robot_->heard();
  expectAllFrames(heard, 300);
  EXPECT_GT(trajectoryOf(heard.states).size(), 50U) << daemon->said();
  EXPECT_LT(errorOf(trajectoryOf(heard.states), parlour_), 0.03);
  EXPECT_FALSE(loadMap(map, *openFrameSource(parlour_)->camera()).points.empty());
  EXPECT_LT(daemon->times("\n"), 40) << "no flood: " << daemon->said();
}

TEST_F(DaemonTest, AReplayAtRealTimePublishesLikewise) {
  const auto replay =
      start({"replay", parlour_, "--realtime", "--lcm", "--output", folder_.path("result"), "--drawings", "0"});
  command_t reset{};
  reset.command = command_t::RESET;
  const command_answer_t answer = robot_->ask(reset);
  EXPECT_FALSE(answer.accepted);
  EXPECT_EQ(answer.message, "a replay does not begin anew");
  ASSERT_EQ(replay->exitCode(), 0) << replay->said();
  ASSERT_TRUE(robot_->hearsStatus([](const status_t& status) { return status.frames_captured == 300; }));
  expectAllFrames(robot_->heard(), 300);
  EXPECT_LT(errorOf(trajectoryOf(robot_->heard().states), parlour_), 0.03);
}

TEST_F(DaemonTest, SignalsEndItAndWriteTheMap) {
  const std::string map = folder_.path("robot.map");
  const auto daemon = startOn(parlour_, {"--map-out", map, "--record", folder_.path("recording")});
  ASSERT_TRUE(isTracking()) << daemon->said();
  daemon->send(SIGHUP);
  ASSERT_TRUE(daemon->says("points saved to " + map)) << daemon->said();
  const Camera camera = *openFrameSource(parlour_)->camera();
  EXPECT_FALSE(loadMap(map, camera).points.empty());
  std::filesystem::remove(map);

  const auto asked = std::chrono::steady_clock::now();
  daemon->send(SIGTERM);
  EXPECT_EQ(daemon->exitCode(), 0) << daemon->said();
  // Less than 0.3 s on an idle computer; here only that it does not wait for the frames to end.
  EXPECT_LT(std::chrono::steady_clock::now() - asked, std::chrono::seconds(5));
  EXPECT_FALSE(loadMap(map, camera).points.empty());
  const std::string decisions = fileContent(folder_.path("recording/decisions.txt"));
  EXPECT_NE(decisions.find("\nend "), std::string::npos) << "the recording has its clean end";
  ASSERT_TRUE(robot_->hearsStatus([](const status_t& status) { return !status.recording; }));
}

TEST_F(DaemonTest, ASavedMapIsGoneOnWithAndOneThatCannotBeIsSetAside) {
  const std::string map = folder_.path("robot.map");
  const std::string configuration = configure("map: {file: " + map + ", go_on: true}\nscale: {metres_per_unit: 2.5}\n");
  folder_.write("robot.map", "no map");
  const auto first = startOn(parlour_, {"--config", configuration});
  ASSERT_EQ(first->exitCode(), 0) << first->said();
  EXPECT_EQ(fileContent(map + ".refused"), "no map") << "nothing is written over";
  EXPECT_EQ(robot_->heard().states.back().scale_state, state_t::SCALE_UNKNOWN) << "the scale is another map's";

  const auto second = startOn(parlour_, {"--config", configuration});
  ASSERT_TRUE(robot_->hearsState([](const state_t& state) { return state.state == state_t::RELOCALISED; }))
      << second->said();
  EXPECT_DOUBLE_EQ(robot_->heard().states.back().scale, 2.5);
  second->send(SIGINT);
  EXPECT_EQ(second->exitCode(), 0) << second->said();
}

// Localisation only: the file is read and never written, whatever the robot asks for.
TEST_F(DaemonTest, AFrozenMapIsLocalisedInAndItsFileStays) {
  const std::string map = folder_.path("robot.map");
  const auto first = startOn(parlour_, {"--map-out", map});
  ASSERT_EQ(first->exitCode(), 0) << first->said();
  const std::string before = fileContent(map);
  ASSERT_FALSE(before.empty());

  const auto second = startOn(parlour_, {"--config", configure("map: {file: " + map + ", frozen: true}\n")});
  ASSERT_TRUE(robot_->hearsState([](const state_t& state) { return state.state == state_t::RELOCALISED; }))
      << second->said();
  second->send(SIGHUP);
  ASSERT_TRUE(second->says("the map is frozen (map.frozen): there is nothing new to save")) << second->said();
  second->send(SIGTERM);
  EXPECT_EQ(second->exitCode(), 0) << second->said();
  EXPECT_TRUE(fileContent(map) == before);
}

}  // namespace
}  // namespace edgeslam
