#include "drivers/lcm/imu_message.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "edgeslam/imu_t.hpp"
#include "edgeslam/pose_t.hpp"
#include "unit/lcm/encoded_message.h"

namespace edgeslam {
namespace {

imu_t goodImuMessage() { return {123456789, {0.1, -0.2, 0.3}, {1, 2, 9.5}}; }

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
  std::vector<std::uint8_t> bytes = encoded(goodImuMessage());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(checkImu(bytes.data(), size)) << size;
  }
  bytes.push_back(0);
  EXPECT_FALSE(checkedSample(bytes));
  EXPECT_FALSE(checkedSample(encoded(pose_t{})));
}

}  // namespace
}  // namespace edgeslam
