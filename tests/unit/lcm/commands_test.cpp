#include "drivers/lcm/commands.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "edgeslam/pose_t.hpp"
#include "unit/geometry/scene_fixture.h"
#include "unit/lcm/encoded_message.h"

namespace edgeslam {
namespace {

command_t scaleCommand(std::int64_t from, std::int64_t to, double distance_m) {
  command_t command{};
  command.id = 42;
  command.command = command_t::SET_SCALE;
  command.from_utime = from;
  command.to_utime = to;
  command.distance_m = distance_m;
  return command;
}

CheckedCommand check(const std::vector<std::uint8_t>& bytes) { return checkCommand(bytes.data(), bytes.size(), 5); }

bool ignored(const CheckedCommand& checked) { return !checked.command && !checked.refusal; }

TEST(Commands, EachKindIsTakenAndAnswered) {
  for (std::int8_t number = command_t::RESET; number <= command_t::SEND_MAP; ++number) {
    command_t message = scaleCommand(1, 2, 0.5);
    message.command = number;
    const CheckedCommand checked = check(encoded(message));
    ASSERT_TRUE(checked.command) << int{number};
    EXPECT_FALSE(checked.refusal);
    EXPECT_EQ(checked.command->id, 42);
    const command_answer_t answer = commandAnswer(*checked.command, true, "done", 8);
    EXPECT_EQ(answer.command, number);
    EXPECT_EQ(answer.id, 42);
    EXPECT_EQ(answer.utime, 8);
    EXPECT_TRUE(answer.accepted);
    EXPECT_EQ(answer.message, "done");
  }
}

TEST(Commands, ADistanceIsTakenOver) {
  const CheckedCommand checked = check(encoded(scaleCommand(100, 200, 1.25)));
  ASSERT_TRUE(checked.command);
  EXPECT_EQ(checked.command->kind, CommandKind::set_scale);
  EXPECT_EQ(checked.command->from_utime, 100);
  EXPECT_EQ(checked.command->to_utime, 200);
  EXPECT_EQ(checked.command->distance_m, 1.25);
}

TEST(Commands, WhatMakesNoSenseIsRefusedWithTheReason) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double distance_m : {0.0, -1.0, nan, std::numeric_limits<double>::infinity(), 1e9}) {
    const CheckedCommand checked = check(encoded(scaleCommand(1, 2, distance_m)));
    EXPECT_FALSE(checked.command) << distance_m;
    ASSERT_TRUE(checked.refusal);
    EXPECT_FALSE(checked.refusal->accepted);
    EXPECT_EQ(checked.refusal->id, 42);
    EXPECT_NE(checked.refusal->message.find("distance_m"), std::string::npos);
  }
  const CheckedCommand backwards = check(encoded(scaleCommand(2, 2, 1)));
  ASSERT_TRUE(backwards.refusal);
  EXPECT_NE(backwards.refusal->message.find("from_utime"), std::string::npos);
  command_t unknown = scaleCommand(1, 2, 1);
  for (const int number : {-128, -1, 0, 7, 127}) {
    unknown.command = static_cast<std::int8_t>(number);
    const CheckedCommand checked = check(encoded(unknown));
    EXPECT_FALSE(checked.command);
    ASSERT_TRUE(checked.refusal) << number;
    EXPECT_EQ(checked.refusal->command, number);
  }
}

TEST(Commands, OtherBytesAreIgnored) {
  const std::vector<std::uint8_t> good = encoded(scaleCommand(1, 2, 1));
  EXPECT_TRUE(ignored(checkCommand(nullptr, 0, 5)));
  for (std::size_t length = 0; length < good.size(); ++length) {
    EXPECT_TRUE(ignored(check({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)}))) << length;
  }
  std::vector<std::uint8_t> longer = good;
  longer.push_back(0);
  EXPECT_TRUE(ignored(check(longer)));
  EXPECT_TRUE(ignored(check(std::vector<std::uint8_t>(300000, 0xff))));
  EXPECT_TRUE(ignored(check(encoded(pose_t{}))));
  for (std::size_t byte = 0; byte < 8; ++byte) {
    std::vector<std::uint8_t> other_type = good;
    other_type[byte] ^= 1;
    EXPECT_TRUE(ignored(check(other_type))) << "hash";
  }
}

TEST(Commands, NoiseOfTheRightTypeNeverPassesTheChecks) {
  Random random(11);
  const std::vector<std::uint8_t> good = encoded(scaleCommand(1, 2, 1));
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::uint8_t> noise = good;
    for (std::size_t byte = 8; byte < noise.size(); ++byte) {
      noise[byte] = static_cast<std::uint8_t>(random.uniform(0, 255.99));
    }
    const CheckedCommand checked = check(noise);
    ASSERT_FALSE(ignored(checked));
    if (!checked.command || checked.command->kind != CommandKind::set_scale) continue;
    EXPECT_GT(checked.command->distance_m, 0);
    EXPECT_LE(checked.command->distance_m, 1e5);
    EXPECT_LT(checked.command->from_utime, checked.command->to_utime);
  }
}

}  // namespace
}  // namespace edgeslam
