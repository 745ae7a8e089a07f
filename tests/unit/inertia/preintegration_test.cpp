// The motion between two times by inertia alone.
#include "inertia/preintegration.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include "unit/inertia/simulated_motion.h"

namespace edgeslam::test {
namespace {

PreintegratedMotion over(const std::vector<InertialSample>& samples, const InertialBias& bias = {}) {
  PreintegratedMotion motion;
  motion.bias = bias;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    motion = joined(motion, preintegrate(InertialUnit(), samples[i - 1], samples[i], bias));
  }
  return motion;
}

Eigen::Matrix<double, 9, 1> difference(const PreintegratedMotion& from, const PreintegratedMotion& to) {
  Eigen::Matrix<double, 9, 1> error;
  error << rotationLog((from.rotation.conjugate() * to.rotation).normalized()), to.velocity - from.velocity,
      to.position - from.position;
  return error;
}

const InertialBias some_bias{{0.02, -0.03, 0.01}, {0.1, 0.2, -0.15}};

TEST(Preintegration, TellsTheMotionWithSpeedAndGravity) {
  const SimulatedMotion simulated;
  for (const double from : {0.0, 1.3, 2.9}) {
    const double seconds = 0.8;
    const PreintegratedMotion motion = over(simulated.measured(from, from + seconds, 1000, some_bias), some_bias);
    const Pose before = simulated.poseAt(from), after = simulated.poseAt(from + seconds);
    const Eigen::Vector3d& g = simulated.gravity;
    EXPECT_NEAR(motion.seconds, seconds, 1e-9);
    EXPECT_LT(rotationAngle(before.rotation * motion.rotation, after.rotation), 1e-5);
    const Eigen::Vector3d velocity = simulated.velocityAt(from) + seconds * g + before.rotation * motion.velocity;
    EXPECT_LT((velocity - simulated.velocityAt(from + seconds)).norm(), 1e-4);
    const Eigen::Vector3d place = before.translation + seconds * simulated.velocityAt(from) +
                                  0.5 * seconds * seconds * g + before.rotation * motion.position;
    EXPECT_LT((place - after.translation).norm(), 1e-4);
  }
}

TEST(Preintegration, OfTwoPartsIsThatOfTheWhole) {
  const SimulatedMotion simulated;
  const auto samples = simulated.measured(0.4, 1.2, 200, some_bias);
  const std::vector<InertialSample> first(samples.begin(), samples.begin() + 71);
  const std::vector<InertialSample> second(samples.begin() + 70, samples.end());
  const PreintegratedMotion whole = over(samples, some_bias);
  const PreintegratedMotion parts = joined(over(first, some_bias), over(second, some_bias));
  EXPECT_LT(difference(whole, parts).norm(), 1e-10);
  EXPECT_TRUE(whole.by_bias.isApprox(parts.by_bias, 1e-9));
  EXPECT_TRUE(whole.covariance.isApprox(parts.covariance, 1e-9));
}

TEST(Preintegration, WithoutItsFirstPartIsTheSecond) {
  const auto samples = SimulatedMotion().measured(0.4, 1.2, 200, some_bias);
  const std::vector<InertialSample> first(samples.begin(), samples.begin() + 71);
  const std::vector<InertialSample> second(samples.begin() + 70, samples.end());
  const PreintegratedMotion expected = over(second, some_bias);
  const PreintegratedMotion rest = remainder(over(samples, some_bias), over(first, some_bias));
  EXPECT_NEAR(rest.seconds, expected.seconds, 1e-9);
  EXPECT_LT(difference(expected, rest).norm(), 1e-10);
  EXPECT_TRUE(rest.by_bias.isApprox(expected.by_bias, 1e-9));
  EXPECT_TRUE(rest.covariance.isApprox(expected.covariance, 1e-9));
}

TEST(Preintegration, OfPartsWithDifferentBiasesTakesTheLatter) {
  const auto samples = SimulatedMotion().measured(0.4, 0.9, 200);
  const std::vector<InertialSample> first(samples.begin(), samples.begin() + 51);
  const std::vector<InertialSample> second(samples.begin() + 50, samples.end());
  const InertialBias small{{1e-3, 2e-3, -1e-3}, {0.01, -0.02, 0.01}};
  const PreintegratedMotion mixed = joined(over(first), over(second, small));
  EXPECT_LT(difference(over(samples, small), mixed).norm(), 1e-5);
}

TEST(Preintegration, DerivativesByTheBiasAreTheNumericOnes) {
  const auto samples = SimulatedMotion().measured(1, 1.6, 400);
  const PreintegratedMotion motion = over(samples, some_bias);
  constexpr double step = 1e-5;
  for (int k = 0; k < 6; ++k) {
    InertialBias more = some_bias, less = some_bias;
    (k < 3 ? more.rate(k) : more.force(k - 3)) += step;
    (k < 3 ? less.rate(k) : less.force(k - 3)) -= step;
    const Eigen::Matrix<double, 9, 1> numeric = difference(over(samples, less), over(samples, more)) / (2 * step);
    EXPECT_LT((numeric - motion.by_bias.col(k)).norm(), 3e-3 * std::max(0.1, numeric.norm())) << "bias " << k;
    EXPECT_LT(difference(over(samples, more), withBias(motion, more)).norm(), 1e-7);
  }
}

TEST(Preintegration, CovarianceIsThatOfNoise) {
  const SimulatedMotion simulated;
  const auto exact = simulated.measured(0.2, 0.7, 200);
  const PreintegratedMotion truth = over(exact);
  const InertialUnit unit;
  std::mt19937 engine(1);  // NOLINT: the same in every run
  std::normal_distribution<double> normal;
  const auto noise = [&](double density) {
    const double sigma = density * std::sqrt(200.0);
    return Eigen::Vector3d(sigma * normal(engine), sigma * normal(engine), sigma * normal(engine));
  };
  constexpr int runs = 400;
  double mean = 0;
  for (int run = 0; run < runs; ++run) {
    PreintegratedMotion motion;
    for (std::size_t i = 1; i < exact.size(); ++i) {
      // Of an interval: both of its ends err alike, so that neighbours do not share noise.
      const Eigen::Vector3d rate = noise(unit.rate_noise), force = noise(unit.force_noise);
      InertialSample from = exact[i - 1], to = exact[i];
      for (InertialSample* sample : {&from, &to}) {
        sample->rate += rate;
        sample->force += force;
      }
      motion = joined(motion, preintegrate(unit, from, to, {}));
    }
    const Eigen::Matrix<double, 9, 1> error = difference(truth, motion);
    mean += error.dot(truth.covariance.ldlt().solve(error)) / runs;
  }
  EXPECT_NEAR(mean, 9, 0.9);
}

}  // namespace
}  // namespace edgeslam::test
