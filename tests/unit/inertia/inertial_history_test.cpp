// What was measured lately, and the motion between two times of it.
#include "inertia/inertial_history.h"

#include <gtest/gtest.h>

#include <limits>

#include "unit/inertia/simulated_motion.h"

namespace edgeslam::test {
namespace {

std::int64_t ns(double seconds) { return std::llround(seconds * 1e9); }

InertialHistory filled(const std::vector<InertialSample>& samples, const InertialUnit& unit = {}) {
  InertialHistory history(unit);
  for (const InertialSample& sample : samples) history.add(sample);
  return history;
}

TEST(InertialHistory, TellsTheMotionBetweenSamplesToo) {
  const SimulatedMotion simulated;
  const InertialHistory history = filled(simulated.measured(0, 2, 500));
  const auto motion = history.between(ns(0.5037), ns(1.1414), {});
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->seconds, 1.1414 - 0.5037, 1e-9);
  const Eigen::Quaterniond turned = simulated.poseAt(0.5037).rotation.conjugate() * simulated.poseAt(1.1414).rotation;
  EXPECT_LT(rotationAngle(motion->rotation, turned), 1e-5);
}

TEST(InertialHistory, IsTheSameInPartsAsInOne) {
  const InertialHistory history = filled(SimulatedMotion().measured(0, 2, 200));
  const auto whole = history.between(ns(0.4), ns(1.2), {});
  const auto first = history.between(ns(0.4), ns(0.7333), {}), second = history.between(ns(0.7333), ns(1.2), {});
  ASSERT_TRUE(whole && first && second);
  const PreintegratedMotion both = joined(*first, *second);
  EXPECT_LT((both.velocity - whole->velocity).norm(), 2e-4);
  EXPECT_LT((both.position - whole->position).norm(), 2e-4);
}

TEST(InertialHistory, KnowsTheOffsetOfItsClock) {
  InertialUnit late;
  late.offset_ns = ns(0.25);
  const auto samples = SimulatedMotion().measured(0, 2, 200);
  const auto shifted = filled(samples, late).between(ns(0.5), ns(0.9), {});
  const auto plain = filled(samples).between(ns(0.75), ns(1.15), {});
  ASSERT_TRUE(shifted && plain);
  EXPECT_LT((shifted->velocity - plain->velocity).norm(), 1e-12);
}

TEST(InertialHistory, TellsNothingOverGaps) {
  std::vector<InertialSample> samples = SimulatedMotion().measured(0, 2, 200);
  EXPECT_FALSE(filled(samples).between(ns(-0.1), ns(0.5), {}));
  EXPECT_FALSE(filled(samples).between(ns(1.5), ns(2.1), {}));
  EXPECT_TRUE(filled(samples).between(ns(1.5), ns(2.01), {})) << "the latest sample lasts for a moment";
  EXPECT_FALSE(filled(samples).between(ns(1), ns(1), {}));
  samples.erase(samples.begin() + 200, samples.begin() + 220);
  EXPECT_FALSE(filled(samples).between(ns(0.5), ns(1.5), {}));
  EXPECT_TRUE(filled(samples).between(ns(0.5), ns(0.9), {}));
  EXPECT_FALSE(InertialHistory({}).between(0, 1, {}));
}

TEST(InertialHistory, TheTurnAloneIsThatOfTheMotion) {
  const InertialBias bias{{0.02, -0.01, 0.03}, {0.1, 0, 0}};
  InertialHistory history({});
  for (const InertialSample& sample : SimulatedMotion().measured(0, 4, 200, bias)) history.add(sample);
  for (const double to_s : {0.3, 1.0, 3.7}) {
    const auto motion = history.between(ns(0.2), ns(to_s), bias);
    const auto turn = history.turnBetween(ns(0.2), ns(to_s), bias);
    ASSERT_TRUE(motion && turn);
    EXPECT_LT(rotationAngle(motion->rotation, *turn), 1e-7);
  }
  EXPECT_FALSE(history.turnBetween(ns(0.2), ns(0.2), bias));
  EXPECT_FALSE(history.turnBetween(ns(3), ns(9), bias));
}

TEST(InertialHistory, LeavesOutWhatCannotBe) {
  InertialHistory history({});
  InertialSample sample;
  sample.time_ns = 1000;
  EXPECT_TRUE(history.add(sample));
  EXPECT_FALSE(history.add(sample)) << "the same time again";
  sample.time_ns = 2000;
  sample.rate.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(history.add(sample));
  sample.rate.x() = 1e6;
  EXPECT_FALSE(history.add(sample));
  sample.rate.x() = 0;
  EXPECT_TRUE(history.add(sample));
}

TEST(InertialHistory, BeginsAnewWhereTheClockWasSetBack) {
  const auto samples = SimulatedMotion().measured(0, 1, 200);
  InertialHistory history({});
  for (InertialSample sample : samples) {
    sample.time_ns += ns(100);
    history.add(sample);
  }
  for (const InertialSample& sample : samples) history.add(sample);
  EXPECT_TRUE(history.between(ns(0.5), ns(0.9), {}));
  EXPECT_FALSE(history.between(ns(100.5), ns(100.9), {}));
}

TEST(InertialHistory, KeepsTheLatestOnly) {
  InertialHistory history({});
  InertialSample sample;
  for (std::size_t i = 0; i < 3 * InertialHistory::most_samples; ++i) {
    sample.time_ns += 1'000'000;
    sample.rate.z() = static_cast<double>(i % 3);
    ASSERT_TRUE(history.add(sample));
  }
  const std::int64_t now = sample.time_ns;
  EXPECT_TRUE(history.between(now - ns(8), now, {}));
  EXPECT_FALSE(history.between(now - ns(9), now, {}));
}

}  // namespace
}  // namespace edgeslam::test
