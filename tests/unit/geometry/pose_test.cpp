// Rigid transformations and the exponential map of rotations.
#include "geometry/pose.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/geometry/scene_fixture.h"

namespace edgeslam {
namespace {

Pose randomPose(Random& random) { return {random.rotation(random.uniform(0, 3.1)), random.vector(5)}; }

void expectSame(const Pose& a, const Pose& b, double tolerance) {
  EXPECT_LT(rotationAngle(a.rotation, b.rotation), std::max(tolerance, 3e-8));
  EXPECT_LT((a.translation - b.translation).norm(), tolerance);
}

TEST(Pose, CompositionActsAsSuccessiveTransformation) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Pose a = randomPose(random), b = randomPose(random), c = randomPose(random);
    const Eigen::Vector3d point = random.vector(10);
    EXPECT_LT(((a * b) * point - a * (b * point)).norm(), 1e-12);
    EXPECT_LT((a.inverse() * (a * point) - point).norm(), 1e-12);
    expectSame((a * b) * c, a * (b * c), 1e-12);
    expectSame(a * a.inverse(), Pose{}, 1e-12);
    EXPECT_NEAR((a * b).rotation.norm(), 1, 1e-14);
  }
}

TEST(Pose, LogInvertsExpUpToPi) {
  Random random(2);
  for (const double angle : {0.0, 1e-15, 1e-12, 1e-9, 0.99e-8, 1.01e-8, 1e-6, 1e-3, 0.5, 2.0, 3.0, 3.1415}) {
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d vector = angle * random.direction();
      const Eigen::Quaterniond rotation = rotationExp(vector);
      EXPECT_NEAR(rotation.norm(), 1, 1e-15);
      EXPECT_LE((rotationLog(rotation) - vector).norm(), 1e-9 * angle);
      EXPECT_LE((rotationLog(Eigen::Quaterniond(-rotation.coeffs())) - vector).norm(), 1e-9 * angle) << "same rotation";
    }
  }
}

TEST(Pose, LogIsAtMostPiLong) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d vector = random.uniform(M_PI, 10) * random.direction();
    const Eigen::Vector3d log = rotationLog(rotationExp(vector));
    EXPECT_LE(log.norm(), M_PI + 1e-12);
    EXPECT_LT(rotationAngle(rotationExp(log), rotationExp(vector)), 1e-7);
  }
}

TEST(Pose, ExpIsTheMatrixExponentialToFirstOrder) {
  Random random(4);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d vector = 1e-5 * random.direction(), point = random.direction();
    EXPECT_LT((rotationExp(vector) * point - (point + skew(vector) * point)).norm(), 1e-10);
  }
}

TEST(Pose, TheSeriesOfASmallRotationIsExactToTheLastBits) {
  Random random(8);
  for (const double share : {1e-12, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.999, 1.001}) {
    const double angle = share * std::sqrt(most_squared_for_series);
    const Eigen::Vector3d axis = random.direction();
    const Eigen::Quaterniond exact(Eigen::AngleAxisd(angle, axis));
    const Eigen::Quaterniond rotation = rotationExp(angle * axis);
    EXPECT_LT((rotation.coeffs() - exact.coeffs()).norm(), 4e-16) << share;
    EXPECT_LT((rotation.vec() - exact.vec()).norm(), 1e-15 * angle) << share;
  }
}

TEST(Pose, SkewIsTheCrossProduct) {
  Random random(5);
  const Eigen::Vector3d a = random.vector(2), b = random.vector(2);
  EXPECT_LT((skew(a) * b - a.cross(b)).norm(), 1e-14);
  EXPECT_EQ(skew(a).transpose(), -skew(a));
}

TEST(Pose, RetractAppliesTheUpdateOnTheRight) {
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const Pose pose = randomPose(random);
    Vector6d update;
    update << random.vector(1), random.vector(1);
    const Pose expected = pose * Pose{rotationExp(update.tail<3>()), update.head<3>()};
    expectSame(retract(pose, update), expected, 1e-12);
    expectSame(retract(pose, Vector6d::Zero()), pose, 1e-15);
    EXPECT_NEAR(rotationAngle(retract(pose, update).rotation, pose.rotation), update.tail<3>().norm(), 1e-7);
  }
}

// What the estimators' Jacobians rest on: d (pose * p) / d update = R [I, -[p]x].
TEST(Pose, RetractHasTheDocumentedDerivative) {
  Random random(7);
  const Pose pose = randomPose(random);
  const Eigen::Vector3d point = random.vector(3);
  Eigen::Matrix<double, 3, 6> expected;
  expected << pose.rotation.toRotationMatrix(), -pose.rotation.toRotationMatrix() * skew(point);
  for (int k = 0; k < 6; ++k) {
    const Vector6d step = 1e-6 * Vector6d::Unit(k);
    const Eigen::Vector3d numeric = (retract(pose, step) * point - retract(pose, -step) * point) / 2e-6;
    EXPECT_LT((numeric - expected.col(k)).norm(), 1e-8) << k;
  }
}

}  // namespace
}  // namespace edgeslam
