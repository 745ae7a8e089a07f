#include "mapping/camera_looks.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

constexpr int interval = 4, enough_keyframes = 24;
constexpr double cost = 10'000;

PrincipalPointEstimate estimateOf(double x_px, double y_px, double sigma_px = 0.2, double gain = 0.04 * cost) {
  return {{x_px, y_px}, sigma_px, gain};
}

bool isToChange(const PrincipalPointEstimate& estimate, PrincipalPointLooks& looks) {
  return edgeslam::isToChange(estimate, cost, interval, enough_keyframes, looks);
}

TEST(CameraLooks, APrincipalPointIsWrongWhereThreeLooksAgree) {
  PrincipalPointLooks looks;
  EXPECT_FALSE(isToChange(estimateOf(6, 5), looks));
  EXPECT_FALSE(isToChange(estimateOf(5, 6), looks));
  EXPECT_TRUE(isToChange(estimateOf(6, 4), looks));
}

TEST(CameraLooks, WhereOneLookDisagreesTheyBeginAnew) {
  PrincipalPointLooks looks;
  for (const PrincipalPointEstimate& other :
       {estimateOf(-6, 5), estimateOf(1, 0), estimateOf(6, 5, 0.6), estimateOf(6, 5, 0.2, 0.01 * cost)}) {
    looks = {};
    isToChange(estimateOf(6, 5), looks);
    isToChange(estimateOf(6, 5), looks);
    EXPECT_FALSE(isToChange(other, looks)) << other.change.transpose();
    EXPECT_FALSE(isToChange(estimateOf(6, 5), looks)) << other.change.transpose();
    EXPECT_FALSE(isToChange(estimateOf(6, 5), looks)) << other.change.transpose();
    EXPECT_TRUE(isToChange(estimateOf(6, 5), looks)) << other.change.transpose();
  }
}

TEST(CameraLooks, OneLookThatExplainsMuchIsBeyondDoubtIfItIsKnownWell) {
  PrincipalPointLooks looks;
  EXPECT_FALSE(isToChange(estimateOf(9, -49, 1.3, 0.19 * cost), looks));
  EXPECT_TRUE(isToChange(estimateOf(8, 1.5, 0.4, 0.12 * cost), looks));
}

TEST(CameraLooks, APrincipalPointThatWasFoundSettlesOnceItStays) {
  PrincipalPointLooks looks;
  ASSERT_TRUE(isToChange(estimateOf(8, 1.5, 0.4, 0.12 * cost), looks));
  EXPECT_TRUE(isToChange(estimateOf(1, 1), looks)) << "still nearer";
  for (int keyframes = interval; keyframes <= enough_keyframes; keyframes += interval) {
    EXPECT_FALSE(looks.is_settled) << keyframes;
    EXPECT_FALSE(isToChange(estimateOf(0.1, 0.1), looks));
  }
  EXPECT_TRUE(looks.is_settled);
}

TEST(CameraLooks, AReadoutBeyondDoubtTakesOneLookAndAFocalLengthThree) {
  CameraLooks readout, focal_length;
  EXPECT_TRUE(edgeslam::isToChange(looking_for_readout, {0.02, 0.0003}, 0, interval, enough_keyframes, readout));
  const auto look = [&] {
    return edgeslam::isToChange(looking_for_focal_length, {-0.1, 0.001}, 0, interval, enough_keyframes, focal_length);
  };
  EXPECT_FALSE(look());
  EXPECT_FALSE(look());
  EXPECT_TRUE(look());
}

TEST(CameraLooks, WhatIsAsPresumedRests) {
  CameraLooks looks;
  for (int keyframes = interval; keyframes <= enough_keyframes; keyframes += interval) {
    EXPECT_FALSE(looks.rests) << keyframes;
    EXPECT_FALSE(edgeslam::isToChange(looking_for_focal_length, {0.001, 0.001}, 0, interval, enough_keyframes, looks));
  }
  EXPECT_TRUE(looks.rests);
}

}  // namespace
}  // namespace edgeslam
