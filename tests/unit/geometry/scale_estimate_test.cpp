#include "geometry/scale_estimate.h"

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

}  // namespace
}  // namespace edgeslam
