#include "scale/scale_estimate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/geometry/scene_fixture.h"

namespace edgeslam {
namespace {

std::vector<ScaleMeasurement> measured(Random& random, int count, double sigma, double claimed_sigma, double truth) {
  std::vector<ScaleMeasurement> measurements;
  for (int i = 0; i < count; ++i) measurements.push_back({truth + random.normal(sigma), claimed_sigma * claimed_sigma});
  return measurements;
}

TEST(ScaleEstimate, TooFewAreNone) {
  Random random(1);
  EXPECT_FALSE(scaleEstimate({}, 0, 0, true));
  EXPECT_FALSE(scaleEstimate(measured(random, 4, 0.1, 0.1, 0), 5, 0, true));
  EXPECT_TRUE(scaleEstimate(measured(random, 5, 0.1, 0.1, 0), 5, 0, true));
}

TEST(ScaleEstimate, IsWithinTwoSigmaAlsoWhereTheMeasurementsClaimTooMuch) {
  for (const double claimed : {0.05, 0.01}) {
    int within = 0, below_all = 0;
    constexpr int runs = 400;
    Random random(2);
    for (int run = 0; run < runs; ++run) {
      const auto estimate = scaleEstimate(measured(random, 20, 0.05, claimed, 0.7), 6, 0, true);
      within += std::abs(estimate->log_scale - 0.7) <= 2 * estimate->sigma;
      below_all += estimate->sigma < 0.04;
    }
    EXPECT_GE(within, runs * 93 / 100) << claimed;
    EXPECT_GE(below_all, runs * 95 / 100) << "it averages out";
  }
}

TEST(ScaleEstimate, WhatIsSharedDoesNotAverageOut) {
  Random random(3);
  const auto measurements = measured(random, 64, 0.01, 0.01, 0);
  EXPECT_GT(scaleEstimate(measurements, 6, 0.03, true)->sigma, 0.03);
  EXPECT_GT(scaleEstimate(measurements, 6, 0, false)->sigma, 0.0099);
}

TEST(ScaleEstimate, AThirdThatIsWrongIsLeftOutAndMoreIsDoubt) {
  Random random(4);
  for (const int wrong : {0, 3, 9, 14}) {
    std::vector<ScaleMeasurement> measurements = measured(random, 30, 0.02, 0.02, 0.5);
    for (int i = 0; i < wrong; ++i) measurements[static_cast<std::size_t>(2 * i)].log_scale += 0.5 + 0.02 * i;
    const auto estimate = scaleEstimate(measurements, 6, 0, true);
    EXPECT_EQ(estimate->problem.empty(), wrong < 10) << wrong;
    if (wrong < 10) {
      EXPECT_NEAR(estimate->log_scale, 0.5, 0.02);
      EXPECT_LT(estimate->sigma, 0.02);
    } else {
      EXPECT_GT(estimate->sigma, 0.3);
    }
  }
}

TEST(GradualScale, IsUnknownUntilItIsKnownWellEnoughAndThenMovesByTheStep) {
  GradualScale gradual(0.1);
  gradual.follow({std::log(2), 0.15, ""}, ScaleKind::odometry);
  EXPECT_EQ(gradual.scale().kind, ScaleKind::unknown);
  gradual.follow({std::log(2), 0.05, "only 3 of 9"}, ScaleKind::odometry);
  EXPECT_EQ(gradual.scale().kind, ScaleKind::unknown);
  gradual.follow({std::log(2), 0.05, ""}, ScaleKind::odometry);
  EXPECT_EQ(gradual.scale().kind, ScaleKind::odometry);
  EXPECT_DOUBLE_EQ(gradual.scale().metres_per_unit, 2);
  EXPECT_DOUBLE_EQ(gradual.scale().sigma, 0.05);

  double before = 2;
  for (int i = 0; i < 100; ++i) {
    gradual.follow({std::log(2.1), 0.02, ""}, ScaleKind::odometry);
    EXPECT_LE(std::abs(std::log(gradual.scale().metres_per_unit / before)), GradualScale::largest_step + 1e-12);
    EXPECT_GE(gradual.scale().sigma, std::abs(std::log(gradual.scale().metres_per_unit / 2.1)));
    before = gradual.scale().metres_per_unit;
  }
  EXPECT_NEAR(before, 2.1, 1e-9);
  EXPECT_NEAR(gradual.scale().sigma, 0.02, 1e-9);
}

TEST(GradualScale, AContradictionMovesNothingAndIsTold) {
  GradualScale gradual(0.1);
  gradual.follow({0, 0.05, ""}, ScaleKind::camera_height);
  gradual.follow({0.3, 0.2, "only 5 of 9"}, ScaleKind::camera_height);
  EXPECT_DOUBLE_EQ(gradual.scale().metres_per_unit, 1);
  EXPECT_GT(gradual.scale().sigma, 0.3);
  EXPECT_EQ(gradual.scale().kind, ScaleKind::camera_height) << "lengths stay metres";
  gradual.follow({0.0, 0.05, ""}, ScaleKind::camera_height);
  EXPECT_DOUBLE_EQ(gradual.scale().sigma, 0.05);
  gradual.forget();
  EXPECT_EQ(gradual.scale().kind, ScaleKind::unknown);
}

}  // namespace
}  // namespace edgeslam
