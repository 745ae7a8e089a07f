// How an inertial unit is turned against the camera, from simulated turns; and what does not tell it.
#include "mapping/unit_rotation_estimate.h"

#include <gtest/gtest.h>

#include "geometry/angles.h"
#include "unit/inertia/turning_camera.h"

namespace edgeslam::test {
namespace {

// As it is given: wrong by a rotation vector in the camera's frame [rad].
InertialUnit unitGiven(const TurningCamera& camera, const Eigen::Vector3d& wrong) {
  InertialUnit unit;
  unit.imu_T_camera.rotation = camera.imu_R_camera * rotationExp(wrong);
  unit.rate_walk = camera.rate_walk;
  unit.offset_ns = std::llround(1e9 * camera.offset_s);
  return unit;
}

std::optional<UnitRotationEstimate> estimateOf(const TurningCamera& camera, unsigned seed, const InertialUnit& unit) {
  return estimateUnitRotation(camera.poses(seed), camera.samples(seed), unit, unit.imu_T_camera.rotation);
}

// What is left of the error of the one that was given, in the camera's frame.
Eigen::Vector3d errorOf(const UnitRotationEstimate& estimate, const TurningCamera& camera, const InertialUnit& unit) {
  const Eigen::Quaterniond found = unit.imu_T_camera.rotation * rotationExp(estimate.change);
  return rotationLog((camera.imu_R_camera.conjugate() * found).normalized());
}

TEST(UnitRotationEstimate, FindsItAsWellAsItSays) {
  double squares = 0;
  int count = 0;
  const std::vector<Eigen::Vector3d> wrong{{0, 0, 0}, {0.02, 0, 0}, {0, -0.03, 0}, {0, 0, 0.05}, {-0.03, 0.02, 0.01}};
  for (const Eigen::Vector3d& by : wrong) {
    for (unsigned seed = 0; seed < 6; ++seed) {
      TurningCamera camera;
      camera.seconds = seed < 3 ? 8 : 20;
      camera.pose_noise_rad = 1e-3;
      const InertialUnit unit = unitGiven(camera, by);
      const std::optional<UnitRotationEstimate> estimate = estimateOf(camera, seed, unit);
      ASSERT_TRUE(estimate) << by.transpose() << ", seed " << seed;
      const Eigen::Vector3d error = errorOf(*estimate, camera, unit);
      const double square = error.dot(estimate->covariance.llt().solve(error));
      EXPECT_LT(square, 25) << by.transpose() << ", seed " << seed;
      EXPECT_LT(error.norm(), radians(0.3)) << by.transpose() << ", seed " << seed;
      EXPECT_NEAR(estimate->seconds, camera.seconds, 0.25);
      squares += square / 3;
      ++count;
    }
  }
  // It allows for errors of poses that go with the motion, which these poses have not.
  EXPECT_LT(squares / count, 1.2);
  EXPECT_GT(squares / count, 0.1);
}

// A robot on a plane floor.
TEST(UnitRotationEstimate, WhatIsNotToldStaysAsItIsGiven) {
  TurningCamera camera;
  camera.swing_rad = {0.004, 0.5, 0.004};
  const Eigen::Vector3d wrong(0.03, 0.03, 0.02);
  const InertialUnit unit = unitGiven(camera, wrong);
  const std::optional<UnitRotationEstimate> estimate = estimateOf(camera, 1, unit);
  ASSERT_TRUE(estimate);
  const Eigen::Vector3d error = errorOf(*estimate, camera, unit);
  const Eigen::Vector3d sigma = estimate->covariance.diagonal().cwiseSqrt();
  EXPECT_LT(std::abs(error.x()), radians(0.3));
  EXPECT_LT(std::abs(error.z()), radians(0.3));
  EXPECT_GT(sigma.y(), 3 * std::max(sigma.x(), sigma.z())) << "it turns about y";
  EXPECT_LT(error.norm(), wrong.norm());
  EXPECT_LT(std::abs(error.y()), 4 * sigma.y());
}

TEST(UnitRotationEstimate, WaitsForTheOffsetOfTheClocks) {
  TurningCamera camera;
  InertialUnit unit = unitGiven(camera, {0.02, 0, 0});
  EXPECT_TRUE(estimateOf(camera, 1, unit));
  unit.offset_ns += 30'000'000;
  EXPECT_FALSE(estimateOf(camera, 1, unit));
}

TEST(UnitRotationEstimate, IsNoneWhereNothingTellsIt) {
  TurningCamera camera;
  camera.swing_rad.setZero();
  const InertialUnit unit = unitGiven(camera, Eigen::Vector3d::Zero());
  const std::optional<UnitRotationEstimate> still = estimateOf(camera, 1, unit);
  EXPECT_TRUE(!still || still->covariance.diagonal().minCoeff() > radians(0.5) * radians(0.5));
  EXPECT_FALSE(estimateUnitRotation({}, camera.samples(1), unit, unit.imu_T_camera.rotation));
  EXPECT_FALSE(estimateUnitRotation(camera.poses(1), {}, unit, unit.imu_T_camera.rotation));
}

}  // namespace
}  // namespace edgeslam::test
