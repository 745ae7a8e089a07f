// What an inertial unit says of keyframes: how that changes with the biases, which are adjusted by it.
#include "mapping/inertial_terms.h"

#include <gtest/gtest.h>

#include "inertia/inertial_history.h"
#include "unit/inertia/simulated_motion.h"

namespace edgeslam::test {
namespace {

struct ThreeKeyframes {
  ThreeKeyframes() {
    unit.imu_T_camera = {Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.05, -0.02, 0.03}};
    const SimulatedMotion motion;
    InertialHistory history(unit);
    for (const InertialSample& sample : motion.measured(0, 1.5, 200, {})) history.add(sample);
    const std::array<double, 3> times_s{0.1, 0.5, 1.2};
    for (int k = 0; k < 3; ++k) {
      Keyframe keyframe;
      keyframe.id = k;
      keyframe.time_ns = std::llround(times_s[static_cast<std::size_t>(k)] * 1e9);
      if (k > 0) keyframe.inertia = {k - 1, *history.between(map.keyframes.back().time_ns, keyframe.time_ns, {})};
      map.keyframes.push_back(std::move(keyframe));
    }
  }
  BundleProblem problemWith(const InertialBias& bias, bool is_free) const {
    InertialAlignment alignment;
    alignment.is_known = true;
    alignment.gravity = {0, 0, -standard_gravity};
    alignment.bias = bias;
    BundleProblem problem;
    addInertialTerms(
        unit, alignment, is_free, map, {0, 1, 2}, [](KeyframeId id) { return static_cast<int>(id); }, problem);
    return problem;
  }

  InertialUnit unit;
  Map map;
};

TEST(InertialTerms, ChangeWithTheBiasesAsTheirDerivativesSay) {
  const ThreeKeyframes made;
  const BundleProblem free = made.problemWith({}, true);
  ASSERT_EQ(free.turns.size(), 2U);
  ASSERT_EQ(free.speed_changes.size(), 1U);
  for (int axis = 0; axis < 6; ++axis) {
    SCOPED_TRACE(axis);
    constexpr double step = 1e-3;
    const Vector6d change = step * Vector6d::Unit(axis);
    const BundleProblem changed = made.problemWith({change.head<3>(), change.tail<3>()}, false);
    for (std::size_t i = 0; i < 2; ++i) {
      const Eigen::Quaterniond expected =
          free.turns[i].first_R_second * rotationExp(free.turns[i].by_rate_bias * change.head<3>());
      EXPECT_LT(rotationAngle(changed.turns[i].first_R_second, expected), 0.01 * step);
    }
    const BundleSpeedChange &before = free.speed_changes[0], &after = changed.speed_changes[0];
    EXPECT_LT((before.of_first + before.first_by_bias * change - after.of_first).norm(), 0.01 * step);
    EXPECT_LT((before.of_second + before.second_by_bias * change - after.of_second).norm(), 0.01 * step);
    EXPECT_GT((after.of_first - before.of_first).norm() +
                  rotationAngle(free.turns[0].first_R_second, changed.turns[0].first_R_second),
              0.01 * step)
        << "the bias matters";
  }
}

TEST(InertialTerms, FreeBiasesBeginWhereTheyWereFoundAndAreNoNoise) {
  const ThreeKeyframes made;
  const InertialBias bias{{0.01, -0.02, 0.03}, {0.1, 0.2, -0.3}};
  const BundleProblem problem = made.problemWith(bias, true);
  EXPECT_TRUE(problem.inertia.is_free);
  EXPECT_EQ(problem.inertia.bias_change.head<3>(), bias.rate);
  EXPECT_EQ(problem.inertia.bias_change.tail<3>(), bias.force);
  EXPECT_EQ(problem.turns[0].first_R_second.coeffs(), made.problemWith({}, true).turns[0].first_R_second.coeffs());
  EXPECT_GT(problem.turns[0].whitening.norm(), made.problemWith(bias, false).turns[0].whitening.norm());
}

}  // namespace
}  // namespace edgeslam::test
