// The measured noise: what is presumed of a good camera stays, what errs more is followed, what contradicts is not.
#include "tracking/measured_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace edgeslam {
namespace {

// Of points whose errors are `deviation` times what is presumed; the first `far` of them contradict the pose.
NoiseEvidence evidenceOf(double deviation, int points, int far = 0, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> error(0, deviation);
  std::pmr::vector<double> errors;
  for (int i = 0; i < points; ++i) errors.push_back(i < far ? 100 : error(random));
  return noiseEvidence(errors, std::pmr::get_default_resource());
}

// What a camera that errs `deviation` times as far as presumed is taken for after some frames.
double factorAfter(int frames, double deviation, int far = 0) {
  MeasuredNoise noise{MeasuredNoiseOptions()};
  for (int frame = 0; frame < frames; ++frame) {
    noise.observe(evidenceOf(deviation / noise.factor(), 400, far, static_cast<std::uint64_t>(frame)));
  }
  return noise.factor();
}

TEST(MeasuredNoise, TheRatioIsThatOfTheStandardDeviations) {
  for (const double deviation : {0.3, 1.0, 2.5}) {
    EXPECT_NEAR(evidenceOf(deviation, 20000).ratio, deviation, 0.05 * deviation);
  }
}

TEST(MeasuredNoise, AGoodCameraKeepsWhatIsPresumed) {
  EXPECT_EQ(factorAfter(200, 0.6), 1);
  EXPECT_LT(factorAfter(200, 1.0), 1.15);
}

TEST(MeasuredNoise, FollowsACameraThatErrsMoreUpToTheBound) {
  EXPECT_NEAR(factorAfter(100, 2.0), 2.0, 0.2);
  EXPECT_EQ(factorAfter(100, 6.0), MeasuredNoiseOptions().most);
}

// A shake that blurs a few frames does not open the gates for what comes after.
TEST(MeasuredNoise, AFewFramesAreNoCamera) {
  MeasuredNoise noise{MeasuredNoiseOptions()};
  for (int frame = 0; frame < 100; ++frame) {
    noise.observe(evidenceOf((frame % 20 < 16 ? 0.6 : 5) / noise.factor(), 400));
    EXPECT_EQ(noise.factor(), 1) << frame;
  }
}

TEST(MeasuredNoise, FallsAgain) {
  MeasuredNoise noise{MeasuredNoiseOptions()};
  for (int frame = 0; frame < 100; ++frame) noise.observe(evidenceOf(3 / noise.factor(), 400));
  for (int frame = 0; frame < 100; ++frame) noise.observe(evidenceOf(0.6 / noise.factor(), 400));
  EXPECT_EQ(noise.factor(), 1);
}

TEST(MeasuredNoise, TheChangeIsThatOfTheFactor) {
  MeasuredNoise noise{MeasuredNoiseOptions()};
  double product = 1;
  for (int frame = 0; frame < 30; ++frame) {
    product *= noise.observe(evidenceOf(frame < 15 ? 5 : 0.2, 400));
    EXPECT_NEAR(product, noise.factor(), 1e-12);
  }
}

// A wrong pose must not buy itself in.
TEST(MeasuredNoise, WhatContradictsTheMapIsNoNoise) {
  EXPECT_EQ(factorAfter(100, 3.0, 80), 1);
  EXPECT_GT(factorAfter(100, 3.0, 20), 2);
}

TEST(MeasuredNoise, AFewPointsOrNoPoseSayNothing) {
  MeasuredNoise noise{MeasuredNoiseOptions()};
  EXPECT_EQ(noise.observe(evidenceOf(3, 19)), 1);
  EXPECT_EQ(noise.observe(evidenceOf(3, 0)), 1);
  EXPECT_EQ(noise.observe(evidenceOf(std::numeric_limits<double>::infinity(), 100)), 1);
  EXPECT_EQ(noise.factor(), 1);
}

}  // namespace
}  // namespace edgeslam
