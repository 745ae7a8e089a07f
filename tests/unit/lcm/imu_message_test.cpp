#include "drivers/lcm/imu_message.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "edgeslam/imu_t.hpp"
#include "edgeslam/pose_t.hpp"

namespace edgeslam {
namespace {

imu_t goodMessage() { return {123456789, {0.1, -0.2, 0.3}, {1, 2, 9.5}}; }

template <class Message>
std::vector<std::uint8_t> bytesOf(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

std::optional<InertialSample> checked(const std::vector<std::uint8_t>& bytes) {
  return checkImu(bytes.data(), bytes.size());
}

TEST(ImuMessage, IsWhatTheUnitMeasured) {
  const std::optional<InertialSample> sample = checked(bytesOf(goodMessage()));
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->time_ns, 123456789000);
  EXPECT_EQ(sample->rate, Eigen::Vector3d(0.1, -0.2, 0.3));
  EXPECT_EQ(sample->force, Eigen::Vector3d(1, 2, 9.5));
}

TEST(ImuMessage, ItsClockMayCountFrom1970) {
  imu_t message = goodMessage();
  message.utime = 1'795'545'900'000'000;
  const std::optional<InertialSample> sample = checked(bytesOf(message));
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->time_ns, 1'795'545'900'000'000'000);
}

TEST(ImuMessage, WhatCannotBeIsNone) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL, 1e4, -1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      imu_t message = goodMessage();
      message.rotation_rate[axis] = bad;
      EXPECT_FALSE(checked(bytesOf(message))) << bad;
      message = goodMessage();
      message.specific_force[axis] = bad;
      EXPECT_FALSE(checked(bytesOf(message))) << bad;
    }
  }
  for (const std::int64_t utime : {std::int64_t{-1}, std::numeric_limits<std::int64_t>::max()}) {
    imu_t message = goodMessage();
    message.utime = utime;
    EXPECT_FALSE(checked(bytesOf(message))) << utime;
  }
}

TEST(ImuMessage, OtherBytesAreNone) {
  std::vector<std::uint8_t> bytes = bytesOf(goodMessage());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(checkImu(bytes.data(), size)) << size;
  }
  bytes.push_back(0);
  EXPECT_FALSE(checked(bytes));
  EXPECT_FALSE(checked(bytesOf(pose_t{})));
}

}  // namespace
}  // namespace edgeslam
