#include "drivers/ros2/heard_odometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/lcm/made_frames.h"

namespace edgeslam {
namespace {

constexpr std::int64_t ms = 1'000'000;

Pose driven(double seconds) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * seconds, Eigen::Vector3d::UnitZ())), {seconds, 0, 0}};
}

TEST(HeardOdometry, IsBetweenItsNeighbours) {
  HeardOdometry heard;
  for (int i = 0; i < 100; ++i) heard.add(i * 20 * ms, driven(0.02 * i));
  for (const std::int64_t at_ms : {0, 7, 20, 999, 1980}) {
    const std::optional<Pose> pose = heard.at(at_ms * ms);
    ASSERT_TRUE(pose) << at_ms;
    const Pose expected = driven(0.001 * static_cast<double>(at_ms));
    EXPECT_NEAR((pose->translation - expected.translation).norm(), 0, 1e-12);
    EXPECT_NEAR(rotationAngle(pose->rotation, expected.rotation), 0, 1e-9);
  }
}

TEST(HeardOdometry, IsNotKnownBeyondWhatWasHeard) {
  HeardOdometry heard;
  EXPECT_FALSE(heard.at(0));
  heard.add(100 * ms, driven(0.1));
  heard.add(200 * ms, driven(0.2));
  EXPECT_FALSE(heard.at(99 * ms));
  EXPECT_FALSE(heard.at(201 * ms));
  heard.add(2000 * ms, driven(2));
  EXPECT_FALSE(heard.at(1000 * ms)) << "nothing was heard for too long";
}

TEST(HeardOdometry, BeginsAnewWhereTheClockWasSetBack) {
  HeardOdometry heard;
  heard.add(5000 * ms, driven(5));
  heard.add(100 * ms, driven(0.1));
  heard.add(200 * ms, driven(0.2));
  EXPECT_TRUE(heard.at(150 * ms));
  EXPECT_FALSE(heard.at(5000 * ms));
}

TEST(HeardOdometry, LeavesOutWhatIsNoPose) {
  HeardOdometry heard;
  heard.add(100 * ms, driven(0.1));
  Pose bad = driven(0.2);
  bad.translation.x() = std::nan("");
  heard.add(200 * ms, bad);
  bad = driven(0.2);
  bad.rotation.coeffs().setZero();
  heard.add(200 * ms, bad);
  bad.rotation.coeffs().setConstant(std::nan(""));
  heard.add(200 * ms, bad);
  EXPECT_FALSE(heard.at(200 * ms));
  EXPECT_TRUE(heard.at(100 * ms));
}

TEST(HeardOdometry, AFloodIsBounded) {
  HeardOdometry heard;
  for (int i = 0; i < 20000; ++i) heard.add(i * 1000, driven(1e-6 * i));
  EXPECT_FALSE(heard.at(0));
  EXPECT_TRUE(heard.at(19999 * 1000));
}

}  // namespace
}  // namespace edgeslam
