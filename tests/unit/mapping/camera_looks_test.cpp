#include "mapping/camera_looks.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

constexpr int interval = 4, enough_keyframes = 24;
constexpr double cost = 10'000;
constexpr LensParts all{true, true, true}, only_focal_length{true, false, false}, none{};

LensEstimate estimateOf(double focal_length, double sigma = 0.005, double gain = 0.04 * cost) {
  LensEstimate estimate;
  estimate.change(0) = focal_length;
  estimate.sigma << sigma, 0.001, 0.001, 1, 1;
  estimate.gain = gain;
  return estimate;
}

bool isToChange(const LensEstimate& estimate, const LensParts& told, LensLooks& looks) {
  return edgeslam::isToChange(estimate, told, cost, interval, enough_keyframes, looks);
}

TEST(CameraLooks, WhatIsToldOfALensCountsInTwoLooksInARowOrBeyondDoubt) {
  LensLooks looks;
  EXPECT_FALSE(any(toldByLooks(only_focal_length, 10, looks)));
  EXPECT_FALSE(any(toldByLooks({false, true, false}, 10, looks)));
  EXPECT_FALSE(any(toldByLooks(only_focal_length, 10, looks)));
  const LensParts twice = toldByLooks(all, 10, looks);
  EXPECT_TRUE(twice.focal_length);
  EXPECT_FALSE(twice.distortion || twice.principal_point);
  LensLooks others;
  EXPECT_TRUE(toldByLooks(only_focal_length, 30, others).focal_length);
}

TEST(CameraLooks, WhatWasFoundOfALensIsToldForEver) {
  LensLooks looks;
  looks.found = {false, false, true};
  const LensParts told = toldByLooks({true, false, true}, 10, looks);
  EXPECT_TRUE(told.principal_point);
  EXPECT_FALSE(told.focal_length);
}

TEST(CameraLooks, ALensChangesWhereItExplainsEnough) {
  LensLooks looks;
  EXPECT_TRUE(isToChange(estimateOf(0.05), only_focal_length, looks));
  EXPECT_FALSE(isToChange(estimateOf(0.05), none, looks)) << "nothing is told";
  EXPECT_FALSE(isToChange(estimateOf(0.05, 0.005, 0.01 * cost), only_focal_length, looks)) << "it explains too little";
}

TEST(CameraLooks, ALensThatWasFoundSettlesOnceItStays) {
  LensLooks looks;
  looks.found = only_focal_length;
  EXPECT_TRUE(isToChange(estimateOf(0.01, 0.005, 10), only_focal_length, looks)) << "still nearer";
  for (int keyframes = interval; keyframes <= enough_keyframes; keyframes += interval) {
    EXPECT_FALSE(looks.is_settled) << keyframes;
    EXPECT_FALSE(isToChange(estimateOf(0.002, 0.005, 10), only_focal_length, looks));
  }
  EXPECT_TRUE(looks.is_settled);
}

TEST(CameraLooks, ALensThatIsAsPresumedRestsIfThatIsKnownWell) {
  LensLooks known, unknown;
  for (int keyframes = interval; keyframes <= enough_keyframes; keyframes += interval) {
    EXPECT_FALSE(known.rests) << keyframes;
    EXPECT_FALSE(isToChange(estimateOf(0.001), none, known));
    EXPECT_FALSE(isToChange(estimateOf(0.001, 0.03), none, unknown));
  }
  EXPECT_TRUE(known.rests);
  EXPECT_FALSE(unknown.rests);
}

TEST(CameraLooks, AReadoutTakesTwoLooksOrOneBeyondDoubt) {
  ReadoutLooks one, two;
  EXPECT_TRUE(edgeslam::isToChange({0.02, 0.0003}, 0, interval, enough_keyframes, one));
  const auto look = [&](double readout_s) {
    return edgeslam::isToChange({readout_s, 0.001}, 0, interval, enough_keyframes, two);
  };
  EXPECT_FALSE(look(0.02));
  EXPECT_FALSE(look(-0.02));
  EXPECT_FALSE(look(0.02));
  EXPECT_TRUE(look(0.021));
}

TEST(CameraLooks, AReadoutIsUnderWayUntilItStays) {
  ReadoutLooks looks;
  EXPECT_FALSE(isUnderWay(looks));
  edgeslam::isToChange({0.02, 0.001}, 0, interval, enough_keyframes, looks);
  EXPECT_TRUE(isUnderWay(looks));
  ASSERT_TRUE(edgeslam::isToChange({0.02, 0.001}, 0, interval, enough_keyframes, looks));
  EXPECT_TRUE(isUnderWay(looks));
  edgeslam::isToChange({0.0205, 0.001}, 0.02, interval, enough_keyframes, looks);
  EXPECT_FALSE(isUnderWay(looks));
}

TEST(CameraLooks, AReadoutThatIsAsPresumedRests) {
  ReadoutLooks looks;
  for (int keyframes = interval; keyframes <= enough_keyframes; keyframes += interval) {
    EXPECT_FALSE(looks.rests) << keyframes;
    EXPECT_FALSE(edgeslam::isToChange({0.0001, 0.0001}, 0, interval, enough_keyframes, looks));
  }
  EXPECT_TRUE(looks.rests);
}

}  // namespace
}  // namespace edgeslam
