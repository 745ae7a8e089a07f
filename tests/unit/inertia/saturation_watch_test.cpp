#include "inertia/saturation_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace edgeslam {
namespace {

constexpr std::int64_t interval_ns = 5'000'000;

// A unit that is shaken along y and turned about z, with noise; its ranges end at these [m/s^2], [rad/s]. Its values
// are whole multiples of a step, as converters give them.
std::vector<InertialSample> shaken(double range_force, double range_rate, double seconds = 5) {
  constexpr double step = 0.001;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.01);
  std::vector<InertialSample> samples;
  const auto measured = [&](double value, double range) {
    return std::clamp(step * std::round((value + noise(random)) / step), -range, range);
  };
  for (int i = 0; i < static_cast<int>(200 * seconds); ++i) {
    const double t = 0.005 * i;
    InertialSample sample;
    sample.time_ns = i * interval_ns;
    for (int k = 0; k < 3; ++k) {
      sample.rate(k) = measured(k == 2 ? 6 * std::sin(3 * t) : 0.1, range_rate);
      sample.force(k) = measured(k == 1 ? 25 * std::sin(11 * t) : 9.8, range_force);
    }
    samples.push_back(sample);
  }
  return samples;
}

TEST(SaturationWatch, AUnitWithinItsRangeIsFine) {
  EXPECT_EQ(saturationProblem(shaken(160, 35)), "");
  EXPECT_EQ(saturationProblem({}), "");
}

TEST(SaturationWatch, WhatIsCutOffIsToldWithItsAxis) {
  EXPECT_EQ(saturationProblem(shaken(19.613, 35)),
            "the accelerometer is cut off at 19.6 m/s^2 along its y axis: set a larger range, or damp what shakes it");
  EXPECT_EQ(saturationProblem(shaken(160, 4.363)),
            "the gyroscope is cut off at 4.36 rad/s along its z axis: set a larger range, or damp what shakes it");
}

// A unit that lies still, or is turned steadily and slowly, may give the same value for long.
TEST(SaturationWatch, WhatIsSteadyIsNotCutOff) {
  std::vector<InertialSample> samples(1000);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = {static_cast<std::int64_t>(i) * interval_ns, {0, 0, 1.5}, {0, 0, 9.81}};
  }
  EXPECT_EQ(saturationProblem(samples), "");
}

TEST(SaturationWatch, ItIsToldForAWhileOnly) {
  SaturationWatch watch;
  const std::vector<InertialSample> cut = shaken(19.613, 35);
  for (const InertialSample& sample : cut) watch.add(sample);
  EXPECT_NE(watch.problem(), "");
  watch.add({cut.back().time_ns + 9'000'000'000, {}, {0, 0, 9.81}});
  EXPECT_NE(watch.problem(), "");
  watch.add({cut.back().time_ns + 11'000'000'000, {}, {0, 0, 9.81}});
  EXPECT_EQ(watch.problem(), "");
}

}  // namespace
}  // namespace edgeslam
