#include "wheels/odometry_history.h"

#include <gtest/gtest.h>

#include <cmath>

namespace edgeslam {
namespace {

OdometryPose poseAt(std::int64_t utime, double x) { return {utime, {rotationExp({0, 0, 0.1 * x}), {x, 0, 0}}}; }

// Each 20 ms from `first_us`, at 0.5 m/s.
void drive(OdometryHistory& history, std::int64_t first_us, int count, double from_x = 0) {
  for (int i = 0; i < count; ++i) history.add(poseAt(first_us + i * 20'000, from_x + 0.01 * i));
}

TEST(OdometryHistory, BetweenMessagesIsInterpolated) {
  OdometryHistory history;
  EXPECT_FALSE(history.newest());
  EXPECT_FALSE(history.at(0));
  drive(history, 1'000'000, 100);
  EXPECT_EQ(*history.newest(), 2'980'000);
  for (const std::int64_t utime : {1'000'000, 1'005'000, 1'999'999, 2'980'000}) {
    const auto at = history.at(utime);
    ASSERT_TRUE(at) << utime;
    const double x = 0.5e-6 * static_cast<double>(utime - 1'000'000);
    EXPECT_NEAR(at->local_T_body.translation.x(), x, 1e-9);
    EXPECT_NEAR(rotationAngle(at->local_T_body.rotation, rotationExp({0, 0, 0.1 * x})), 0, 1e-6);
  }
  EXPECT_FALSE(history.at(999'999));
  EXPECT_FALSE(history.at(2'980'001)) << "not there yet";
}

TEST(OdometryHistory, RepeatedAndOlderMessagesAreLeftOut) {
  OdometryHistory history;
  drive(history, 1'000'000, 50);
  for (int i = 0; i < 1000; ++i) history.add(poseAt(1'980'000, 77));
  for (int i = 0; i < 10; ++i) history.add(poseAt(1'500'000, 77));
  EXPECT_NEAR(history.at(1'980'000)->local_T_body.translation.x(), 0.49, 1e-9);
  EXPECT_NEAR(history.at(1'500'000)->local_T_body.translation.x(), 0.25, 1e-9);
}

TEST(OdometryHistory, AClockThatWasSetBackBeginsAnew) {
  OdometryHistory history;
  history.add(poseAt(90'000'000'000'000'000, 0));  // one that is wrong
  drive(history, 1'000'000, 100);
  ASSERT_TRUE(history.at(2'500'000));
  EXPECT_EQ(*history.newest(), 2'980'000);
}

TEST(OdometryHistory, GapsAndJumpsBeginAnotherPiece) {
  OdometryHistory history;
  drive(history, 1'000'000, 50);       // to 1.98 s
  drive(history, 3'000'000, 50, 0.5);  // after a gap
  drive(history, 4'000'000, 50, 900);  // after a jump
  const auto first = history.at(1'500'000), second = history.at(3'500'000), third = history.at(4'500'000);
  ASSERT_TRUE(first && second && third);
  EXPECT_NE(first->piece, second->piece);
  EXPECT_NE(second->piece, third->piece);
  EXPECT_FALSE(history.at(2'500'000)) << "in the gap";
  EXPECT_FALSE(history.at(3'990'000)) << "in the jump";
  EXPECT_EQ(history.at(3'900'000)->piece, second->piece);
}

TEST(OdometryHistory, KeepsSomeSecondsHoweverManyMessages) {
  OdometryHistory history;
  for (int i = 0; i < 200'000; ++i) history.add(poseAt(1'000'000 + i, 1e-6 * i));
  EXPECT_FALSE(history.at(1'000'001));
  EXPECT_TRUE(history.at(1'199'000));
  drive(history, 2'000'000, 500);
  EXPECT_FALSE(history.at(6'900'000));
  EXPECT_TRUE(history.at(7'100'000));
}

TEST(OdometryHistory, ShortlyAfterTheNewestTheBodyMovesOn) {
  OdometryHistory history;
  EXPECT_FALSE(history.atOrSoonAfter(0));
  history.add(poseAt(1'000'000, 0));
  EXPECT_FALSE(history.atOrSoonAfter(1'010'000)) << "it is not known how it moves";
  drive(history, 1'020'000, 50, 0.01);
  const std::int64_t newest = *history.newest();
  EXPECT_EQ(history.atOrSoonAfter(newest)->beyond_s, 0);
  for (const std::int64_t after : {1'000, 20'000, 50'000}) {
    EXPECT_FALSE(history.at(newest + after));
    const auto place = history.atOrSoonAfter(newest + after);
    ASSERT_TRUE(place) << after;
    const double x = 0.5e-6 * static_cast<double>(newest + after - 1'000'000);
    EXPECT_NEAR(place->local_T_body.translation.x(), x, 1e-9);
    EXPECT_NEAR(rotationAngle(place->local_T_body.rotation, rotationExp({0, 0, 0.1 * x})), 0, 1e-6);
    EXPECT_NEAR(place->way_m, x, 1e-9);
    EXPECT_NEAR(place->beyond_s, 1e-6 * static_cast<double>(after), 1e-12);
    EXPECT_EQ(place->piece, history.at(newest)->piece);
  }
  EXPECT_FALSE(history.atOrSoonAfter(newest + 51'000));
  history.add(poseAt(newest + 20'000, 900));
  EXPECT_FALSE(history.atOrSoonAfter(newest + 30'000)) << "it jumped";
}

TEST(OdometryHistory, WhatCannotBeIsLeftOut) {
  OdometryHistory history;
  OdometryPose pose = poseAt(1'000'000, 0);
  EXPECT_TRUE(history.add(pose));
  EXPECT_FALSE(history.add(pose)) << "the same time again";
  pose = poseAt(1'010'000, std::nan(""));
  EXPECT_FALSE(history.add(pose));
  pose = poseAt(1'010'000, 0);
  pose.local_T_body.rotation.w() = 2;
  EXPECT_FALSE(history.add(pose));
  EXPECT_FALSE(history.add(poseAt(-5, 0)));
  EXPECT_TRUE(history.add(poseAt(1'010'000, 0)));
}

}  // namespace
}  // namespace edgeslam
