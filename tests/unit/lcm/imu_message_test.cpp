#include "drivers/lcm/imu_message.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "bot_core/ins_t.hpp"
#include "edgeslam/imu_t.hpp"
#include "edgeslam/ins_t.hpp"
#include "edgeslam/pose_t.hpp"
#include "unit/lcm/encoded_message.h"

namespace edgeslam {
namespace {

imu_t goodImuMessage() { return {123456789, {0.1, -0.2, 0.3}, {1, 2, 9.5}}; }

// The type as others publish it.
bot_core::ins_t goodInsMessage() {
  bot_core::ins_t message{};
  message.utime = 123456789;
  message.device_time = 77;
  const double rate[3] = {0.1, -0.2, 0.3}, force[3] = {1, 2, 9.5};
  std::copy_n(rate, 3, message.gyro);
  std::copy_n(force, 3, message.accel);
  return message;
}

std::optional<InertialSample> checkedSample(const std::vector<std::uint8_t>& bytes) {
  return checkImu(bytes.data(), bytes.size());
}

TEST(ImuMessage, IsWhatTheUnitMeasured) {
  const std::optional<InertialSample> sample = checkedSample(encoded(goodImuMessage()));
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->time_ns, 123456789000);
  EXPECT_EQ(sample->rate, Eigen::Vector3d(0.1, -0.2, 0.3));
  EXPECT_EQ(sample->force, Eigen::Vector3d(1, 2, 9.5));
}

TEST(ImuMessage, MayBeThePublishedOne) {
  const std::optional<InertialSample> sample = checkedSample(encoded(goodInsMessage()));
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->time_ns, 123456789000);
  EXPECT_EQ(sample->rate, Eigen::Vector3d(0.1, -0.2, 0.3));
  EXPECT_EQ(sample->force, Eigen::Vector3d(1, 2, 9.5));
}

// The hash that programs in the field compare with: of the published type, rotated as LCM does.
TEST(ImuMessage, HasThePublishedHash) {
  const std::uint64_t base = 0x4453efb0a1158420ULL;
  EXPECT_EQ(static_cast<std::uint64_t>(ins_t::getHash()), (base << 1) + (base >> 63));
  EXPECT_EQ(ins_t::getHash(), bot_core::ins_t::getHash());
}

TEST(ImuMessage, OfThePublishedOneTheRestIsNotLookedAt) {
  bot_core::ins_t message = goodInsMessage();
  message.device_time = -1;
  message.mag[0] = message.quat[1] = message.pressure = message.rel_alt = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(checkedSample(encoded(message)));
  for (double(*values)[3] : {&message.gyro, &message.accel}) {
    (*values)[2] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(checkedSample(encoded(message)));
    (*values)[2] = 0;
  }
  EXPECT_TRUE(checkedSample(encoded(message)));
  message.utime = -1;
  EXPECT_FALSE(checkedSample(encoded(message)));
}

TEST(ImuMessage, ItsClockMayCountFrom1970) {
  imu_t message = goodImuMessage();
  message.utime = 1'795'545'900'000'000;
  const std::optional<InertialSample> sample = checkedSample(encoded(message));
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->time_ns, 1'795'545'900'000'000'000);
}

TEST(ImuMessage, WhatCannotBeIsNone) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL, 1e4, -1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      imu_t message = goodImuMessage();
      message.rotation_rate[axis] = bad;
      EXPECT_FALSE(checkedSample(encoded(message))) << bad;
      message = goodImuMessage();
      message.specific_force[axis] = bad;
      EXPECT_FALSE(checkedSample(encoded(message))) << bad;
    }
  }
  for (const std::int64_t utime : {std::int64_t{-1}, std::numeric_limits<std::int64_t>::max()}) {
    imu_t message = goodImuMessage();
    message.utime = utime;
    EXPECT_FALSE(checkedSample(encoded(message))) << utime;
  }
}

TEST(ImuMessage, OtherBytesAreNone) {
  for (std::vector<std::uint8_t> bytes : {encoded(goodImuMessage()), encoded(goodInsMessage())}) {
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_FALSE(checkImu(bytes.data(), size)) << size;
    }
    bytes.push_back(0);
    EXPECT_FALSE(checkedSample(bytes));
    bytes.pop_back();
    bytes[0] ^= 1;
    EXPECT_FALSE(checkedSample(bytes));
  }
  EXPECT_FALSE(checkedSample(encoded(pose_t{})));
}

}  // namespace
}  // namespace edgeslam
