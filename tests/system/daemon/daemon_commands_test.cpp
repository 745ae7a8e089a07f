// Commands of the robot, carried out by the real program.
#include <gtest/gtest.h>

#include <cmath>

#include "system/daemon/daemon_fixture.h"
#include "system/program.h"

namespace edgeslam {
namespace {

double wayBetween(const state_t& a, const state_t& b) {
  double squares = 0;
  for (int i = 0; i < 3; ++i) squares += std::pow(b.camera_position[i] - a.camera_position[i], 2);
  return std::sqrt(squares);
}

// Two frames as far from each other as possible.
std::pair<state_t, state_t> farApart(const std::vector<state_t>& states) {
  std::vector<state_t> measured;
  for (const state_t& state : states) {
    if (isMeasured(state)) measured.push_back(state);
  }
  std::pair<state_t, state_t> farthest{measured.front(), measured.front()};
  for (const state_t& state : measured) {
    if (wayBetween(measured.front(), state) > wayBetween(farthest.first, farthest.second)) farthest.second = state;
  }
  return farthest;
}

class DaemonCommands : public DaemonTest {};

TEST_F(DaemonCommands, TheScaleIsSetFromAKnownDistanceAndForgottenWithItsMap) {
  const auto daemon = startOn(parlour_);
  ASSERT_TRUE(isTracking()) << daemon->said();
  command_t command{};
  command.command = command_t::SET_SCALE;
  command.distance_m = 2;
  command.from_utime = command.to_utime = robot_->heard().states.back().utime;
  EXPECT_FALSE(robot_->ask(command).accepted) << "no distance";
  command.from_utime = 5;
  EXPECT_NE(robot_->ask(command).message.find("from_utime is the time stamp of no frame"), std::string::npos);

  ASSERT_TRUE(robot_->hears([](const Heard& heard) { return trajectoryOf(heard.states).size() > 60; }));
  const auto [from, to] = farApart(robot_->heard().states);
  command.from_utime = from.utime;
  command.to_utime = to.utime;
  const command_answer_t answer = robot_->ask(command);
  ASSERT_TRUE(answer.accepted) << answer.message;
  ASSERT_TRUE(robot_->hearsState([](const state_t& state) { return state.scale_state != state_t::SCALE_UNKNOWN; }));
  const state_t scaled = robot_->heard().states.back();
  EXPECT_EQ(scaled.scale_state, state_t::SCALE_FROM_KNOWN_DISTANCE);
  EXPECT_NEAR(scaled.scale, 2 / wayBetween(from, to), 1e-9);
  EXPECT_GT(scaled.scale_sigma, 0);
  EXPECT_LT(scaled.scale_sigma, 0.1);

  const command_answer_t reset = robot_->ask(command_t::RESET);
  EXPECT_TRUE(reset.accepted) << reset.message;
  ASSERT_TRUE(robot_->hearsState([](const state_t& state) { return state.state == state_t::INITIALISING; }));
  EXPECT_EQ(robot_->heard().states.back().scale_state, state_t::SCALE_UNKNOWN);
}

TEST_F(DaemonCommands, TheMapIsSentAndSavedOnCommand) {
  const std::string map = folder_.path("robot.map");
  const auto daemon =
      startOn(parlour_, {"--config", configure("map: {file: " + map + "}\nlcm: {map_interval_s: 0}\n")});
  const command_answer_t early = robot_->ask(command_t::SAVE_MAP);
  ASSERT_TRUE(isTracking()) << daemon->said();
  EXPECT_TRUE(early.accepted || early.message == "there is no map yet") << early.message;
  EXPECT_TRUE(robot_->ask(command_t::SAVE_MAP).accepted) << daemon->said();
  EXPECT_GT(std::filesystem::file_size(map), 10000U);

  EXPECT_TRUE(robot_->heard().map_parts.empty()) << "on request only";
  EXPECT_TRUE(robot_->heard().line_parts.empty()) << "on request only";
  EXPECT_TRUE(robot_->ask(command_t::SEND_MAP).accepted);
  ASSERT_TRUE(robot_->hears([](const Heard& heard) {
    return !heard.map_parts.empty() && heard.map_parts.back().part + 1 == heard.map_parts.back().parts;
  }));
  const Heard heard = robot_->heard();
  const map_part_t& last = heard.map_parts.back();
  std::int64_t points = 0, lines = 0;
  for (const map_part_t& part : heard.map_parts) {
    if (part.version == last.version) points += part.points;
  }
  EXPECT_EQ(points, last.points_in_map);
  EXPECT_GT(points, 100);
  ASSERT_FALSE(heard.line_parts.empty());
  for (const map_lines_t& part : heard.line_parts) {
    if (part.version == last.version) lines += part.lines;
  }
  EXPECT_EQ(heard.line_parts.back().version, last.version);
  EXPECT_EQ(heard.line_parts.back().utime, last.utime);
  EXPECT_EQ(lines, heard.line_parts.back().lines_in_map);
}

TEST_F(DaemonCommands, WhatIsNotConfiguredIsRefusedWithTheKeyToSet) {
  const auto daemon = startOn(parlour_);
  EXPECT_NE(robot_->ask(command_t::SAVE_MAP).message.find("map.file"), std::string::npos);
  EXPECT_NE(robot_->ask(command_t::START_RECORDING).message.find("recording.folder"), std::string::npos);
  EXPECT_EQ(robot_->ask(command_t::STOP_RECORDING).message, "there is no recording");
  const std::size_t before = robot_->heard().states.size();
  EXPECT_TRUE(robot_->hears([&](const Heard& heard) { return heard.states.size() > before + 10; })) << "it goes on";
  EXPECT_EQ(robot_->heard().states.front().sequence, 0);
}

TEST_F(DaemonCommands, ARecordingOfAPartRepeatsThatPart) {
  const std::string recordings = folder_.path("recordings");
  const auto daemon = startOn(parlour_, {"--config", configure("recording: {folder: " + recordings + "}\n")});
  ASSERT_TRUE(robot_->hears([](const Heard& heard) { return trajectoryOf(heard.states).size() > 30; }));
  const command_answer_t begun = robot_->ask(command_t::START_RECORDING);
  ASSERT_TRUE(begun.accepted) << begun.message;
  EXPECT_FALSE(robot_->ask(command_t::START_RECORDING).accepted) << "there is one already";
  const std::size_t poses_before = trajectoryOf(robot_->heard().states).size();
  ASSERT_TRUE(robot_->hears([&](const Heard& heard) { return trajectoryOf(heard.states).size() > poses_before + 30; }))
      << "tracking finds its map again: " << daemon->said();
  EXPECT_TRUE(robot_->heard().statuses.back().recording || robot_->heard().statuses.size() < 3);
  const command_answer_t ended = robot_->ask(command_t::STOP_RECORDING);
  EXPECT_TRUE(ended.accepted) << ended.message;
  daemon->send(SIGTERM);
  ASSERT_EQ(daemon->exitCode(), 0) << daemon->said();

  const std::string recording = std::filesystem::directory_iterator(recordings)->path().string();
  EXPECT_EQ(fileContent(recording + "/decisions.txt").find("gap"), std::string::npos);
  expectRepeats(recording);
}

}  // namespace
}  // namespace edgeslam
