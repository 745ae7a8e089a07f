#include "drivers/lcm/odometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "bot_core/pose_t.hpp"
#include "edgeslam/command_t.hpp"
#include "unit/lcm/encoded_message.h"

namespace edgeslam {
namespace {

// The type as others publish it.
bot_core::pose_t goodPoseMessage() {
  bot_core::pose_t message{};
  message.utime = 123456789;
  message.pos[0] = 1;
  message.pos[1] = -2;
  message.pos[2] = 0.5;
  message.orientation[0] = 0.8;
  message.orientation[3] = -0.6;
  return message;
}

std::optional<OdometryPose> checkedPose(const std::vector<std::uint8_t>& bytes) {
  return checkOdometry(bytes.data(), bytes.size());
}

TEST(Odometry, IsThePublishedPose) {
  const std::optional<OdometryPose> pose = checkedPose(encoded(goodPoseMessage()));
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->utime, 123456789);
  EXPECT_EQ(pose->local_T_body.translation, Eigen::Vector3d(1, -2, 0.5));
  EXPECT_NEAR(rotationAngle(pose->local_T_body.rotation, Eigen::Quaterniond(0.8, 0, 0, -0.6)), 0, 1e-12);
}

TEST(Odometry, WhatCannotBeIsNone) {
  const double not_a_number = std::numeric_limits<double>::quiet_NaN(), infinite = HUGE_VAL;
  for (const double bad : {not_a_number, infinite, -infinite, 1e8, 1e300}) {
    for (int i = 0; i < 3; ++i) {
      bot_core::pose_t message = goodPoseMessage();
      message.pos[i] = bad;
      EXPECT_FALSE(checkedPose(encoded(message))) << bad;
    }
    for (int i = 0; i < 4; ++i) {
      bot_core::pose_t message = goodPoseMessage();
      message.orientation[i] = bad;
      EXPECT_FALSE(checkedPose(encoded(message))) << bad;
    }
  }
  for (const double factor : {0.0, 0.5, 1.02}) {
    bot_core::pose_t message = goodPoseMessage();
    for (double& number : message.orientation) number *= factor;
    EXPECT_FALSE(checkedPose(encoded(message))) << factor;
  }
  for (const std::int64_t utime : {std::int64_t{-1}, std::numeric_limits<std::int64_t>::max()}) {
    bot_core::pose_t message = goodPoseMessage();
    message.utime = utime;
    EXPECT_FALSE(checkedPose(encoded(message))) << utime;
  }
}

TEST(Odometry, VelocitiesAreNotLookedAt) {
  bot_core::pose_t message = goodPoseMessage();
  message.vel[0] = message.accel[1] = message.rotation_rate[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(checkedPose(encoded(message)));
}

TEST(Odometry, OtherBytesAreNone) {
  const std::vector<std::uint8_t> good = encoded(goodPoseMessage());
  for (std::size_t size = 0; size < good.size(); ++size) EXPECT_FALSE(checkOdometry(good.data(), size));
  std::vector<std::uint8_t> longer = good;
  longer.push_back(0);
  EXPECT_FALSE(checkedPose(longer));
  std::vector<std::uint8_t> another_type = good;
  another_type[0] ^= 1;
  EXPECT_FALSE(checkedPose(another_type));
  EXPECT_FALSE(checkedPose(encoded(command_t{})));
}

}  // namespace
}  // namespace edgeslam
