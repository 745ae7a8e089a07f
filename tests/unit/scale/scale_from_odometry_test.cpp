#include "scale/scale_from_odometry.h"

#include <gtest/gtest.h>

#include "unit/scale/driven_robot.h"

namespace edgeslam {
namespace {

OdometryOptions usual() {
  OdometryOptions options;
  options.channel = "WHEELS";
  return options;
}

ScaleFromOdometry after(const Drive& drive, const DrivenRobot& robot, const OdometryOptions& options = usual()) {
  ScaleFromOdometry scale(options, robot.body_T_camera);
  playBack(drive, scale);
  return scale;
}

double errorOf(const ScaleEstimate& estimate, const DrivenRobot& robot) {
  return estimate.log_scale - std::log(robot.metres_per_unit);
}

TEST(ScaleFromOdometry, WithoutNoiseIsExactWhereverTheCameraSits) {
  DrivenRobot robot;
  robot.position_sigma = 1e-9;
  for (const Eigen::Vector3d& lever :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.3, 0.1, 0.4), Eigen::Vector3d(-0.5, 0.6, 1)}) {
    robot.body_T_camera.translation = lever;
    const ScaleFromOdometry scale = after(drive(robot, 1), robot);
    ASSERT_TRUE(scale.estimate()) << scale.problem();
    // Between two messages the odometry is taken for straight.
    EXPECT_NEAR(errorOf(*scale.estimate(), robot), 0, 2e-4) << lever.transpose();
    EXPECT_EQ(scale.estimate()->problem, "");
    EXPECT_EQ(scale.problem(), "");
    EXPECT_GE(scale.estimate()->sigma, usual().sigma) << "what the wheels' size is not known to does not average out";
    EXPECT_LT(scale.estimate()->sigma, 0.05);
  }
}

TEST(ScaleFromOdometry, ACameraTakenToSitElsewhereIsWrongOrRefused) {
  DrivenRobot robot;
  const Drive driven = drive(robot, 1);
  robot.body_T_camera.translation = {-2, 0, 0.4};
  const ScaleFromOdometry scale = after(driven, robot);
  EXPECT_TRUE(!scale.estimate() || std::abs(errorOf(*scale.estimate(), robot)) > 0.01) << "the test can fail";
}

TEST(ScaleFromOdometry, TheErrorIsWithinTwoSigmaInNineteenOfTwentyDrives) {
  const OdometryOptions options = usual();
  int within = 0;
  constexpr int drives = 100;
  Random random(5);
  for (unsigned seed = 0; seed < drives; ++seed) {
    DrivenRobot robot;
    robot.seconds = 12;
    robot.metres_per_unit = std::exp(random.uniform(-2, 2));
    robot.position_sigma = 0.01 / robot.metres_per_unit;
    robot.wheel_scale = 1 + random.normal(options.sigma);
    robot.slip_per_metre = options.sigma_per_metre;
    const ScaleFromOdometry scale = after(drive(robot, seed), robot, options);
    ASSERT_TRUE(scale.estimate()) << scale.problem();
    EXPECT_LT(scale.estimate()->sigma, 0.06);
    within += std::abs(errorOf(*scale.estimate(), robot)) <= 2 * scale.estimate()->sigma;
  }
  EXPECT_GE(within, drives * 95 / 100);
}

TEST(ScaleFromOdometry, AShortSlipIsLeftOut) {
  DrivenRobot robot;
  robot.spin = [](double t) { return t > 10 && t < 14 ? 1.5 : 0.0; };
  const ScaleFromOdometry scale = after(drive(robot, 2), robot);
  ASSERT_TRUE(scale.estimate()) << scale.problem();
  EXPECT_EQ(scale.estimate()->problem, "");
  EXPECT_NEAR(errorOf(*scale.estimate(), robot), 0, 0.01);
}

TEST(ScaleFromOdometry, ALongSlipShowsAsDoubt) {
  DrivenRobot robot;
  robot.spin = [](double t) { return t > 15 ? 0.6 : 0.0; };
  const ScaleFromOdometry scale = after(drive(robot, 2), robot);
  ASSERT_TRUE(scale.estimate());
  EXPECT_GT(scale.estimate()->sigma, 0.2);
  EXPECT_NE(scale.estimate()->problem.find("agree"), std::string::npos);
}

TEST(ScaleFromOdometry, WheelsThatSpinOnTheSpotTellNothing) {
  DrivenRobot robot;
  Drive driven = drive(robot, 3);
  for (MeasuredPose& frame : driven.frames) frame.world_T_camera = driven.frames.front().world_T_camera;
  for (OdometryPose& pose : driven.odometry) pose.local_T_body.rotation.setIdentity();
  const ScaleFromOdometry scale = after(driven, robot);
  EXPECT_FALSE(scale.estimate());
  EXPECT_NE(scale.problem().find("the odometry moves, the camera does not"), std::string::npos) << scale.problem();
}

TEST(ScaleFromOdometry, AnotherTurnOrAnotherWayIsToldWithItsAngle) {
  DrivenRobot robot;
  const Drive driven = drive(robot, 3);
  DrivenRobot sideways = robot;
  sideways.body_T_camera.rotation = rotationExp({0, 0, M_PI / 2}) * robot.body_T_camera.rotation;
  EXPECT_NE(after(driven, sideways).problem().find("way is 9"), std::string::npos) << after(driven, sideways).problem();
  DrivenRobot rolled = robot;
  rolled.body_T_camera.rotation = rotationExp({M_PI, 0, 0}) * robot.body_T_camera.rotation;
  EXPECT_FALSE(after(driven, sideways).estimate());
  EXPECT_FALSE(after(driven, rolled).estimate());
}

TEST(ScaleFromOdometry, MotionsThatTurnToOtherSidesAreNoComparison) {
  const DrivenRobot robot;
  MeasuredPose before, now;
  before.covariance_camera = now.covariance_camera = 1e-8 * Matrix6d::Identity();
  const Pose left{rotationExp({0, 0, 0.4}), {0.5, 0.1, 0}}, right{rotationExp({0, 0, -0.4}), {0.5, 0.1, 0}};
  now.world_T_camera = robot.body_T_camera.inverse() * left * robot.body_T_camera;
  const MotionComparison same = compareMotions(left, before, now, robot.body_T_camera, usual());
  EXPECT_EQ(same.problem, "");
  EXPECT_NEAR(same.measurement.log_scale, 0, 1e-9);
  EXPECT_EQ(compareMotions(right, before, now, robot.body_T_camera, usual()).problem,
            "the odometry's turn is 46 degrees off the camera's");
}

TEST(ScaleFromOdometry, AnotherClockIsTold) {
  DrivenRobot robot;
  robot.seconds = 5;
  for (const double ahead_s : {3600.0, -3600.0}) {
    Drive driven = drive(robot, 4);
    for (OdometryPose& pose : driven.odometry) pose.utime += std::llround(1e6 * ahead_s) + 4'000'000'000;
    for (MeasuredPose& frame : driven.frames) frame.time_ns += 4'000'000'000'000;
    ScaleFromOdometry scale(usual(), robot.body_T_camera);
    for (std::size_t i = 0; i < driven.frames.size(); ++i) {
      scale.add(driven.odometry[i]);
      scale.add(driven.frames[i]);
    }
    EXPECT_FALSE(scale.estimate());
    EXPECT_NE(scale.problem().find("both must be CLOCK_MONOTONIC"), std::string::npos) << scale.problem();
  }
}

TEST(ScaleFromOdometry, AStopOfTheMessagesIsTold) {
  const DrivenRobot robot;
  ScaleFromOdometry scale = after(drive(robot, 5), robot);
  EXPECT_EQ(scale.problem(), "");
  for (int i = 0; i < 3; ++i) scale.secondPassed();
  EXPECT_EQ(scale.problem(), "no odometry on WHEELS");
  EXPECT_TRUE(scale.estimate()) << "what is known stays";
  scale.clear();
  EXPECT_FALSE(scale.estimate());
}

TEST(ScaleFromOdometry, WhatIsBeforeABreakIsNotComparedWithWhatIsAfter) {
  DrivenRobot robot;
  robot.seconds = 24;
  Drive driven = drive(robot, 6);
  ScaleFromOdometry scale(usual(), robot.body_T_camera);
  // Each second the map jumps.
  std::size_t next = 0;
  for (std::size_t i = 0; i < driven.frames.size(); ++i) {
    MeasuredPose frame = driven.frames[i];
    frame.world_T_camera.translation.x() += 3.0 * static_cast<double>(i / 60);
    for (; driven.odometry[next].utime <= frame.time_ns / 1000; ++next) scale.add(driven.odometry[next]);
    if (i % 60 == 0) scale.breakOff();
    scale.add(frame);
  }
  ASSERT_TRUE(scale.estimate()) << scale.problem();
  EXPECT_NEAR(errorOf(*scale.estimate(), robot), 0, 0.02);
}

}  // namespace
}  // namespace edgeslam
