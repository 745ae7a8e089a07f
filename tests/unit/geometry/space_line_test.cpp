#include "geometry/space_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene_fixture.h"

namespace edgeslam {
namespace {

SpaceLine randomLine(Random& random) { return {random.vector(3), random.direction()}; }

TEST(SpaceLine, BasisIsOrthonormalAndAcrossTheDirection) {
  Random random(1);
  std::vector<Eigen::Vector3d> directions{Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(),
                                          Eigen::Vector3d::Ones().normalized()};
  for (int i = 0; i < 100; ++i) directions.push_back(random.direction());
  for (const Eigen::Vector3d& direction : directions) {
    const LineBasis basis = lineBasis(direction);
    Eigen::Matrix3d all;
    all << basis, direction;
    EXPECT_TRUE((all.transpose() * all).isApprox(Eigen::Matrix3d::Identity(), 1e-12));
    EXPECT_EQ(basis, lineBasis(Eigen::Vector3d(direction)));
  }
}

TEST(SpaceLine, IsShiftedAndTurnedAcrossItself) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const SpaceLine line = randomLine(random);
    const Eigen::Vector4d change(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.5, 0.5),
                                 random.uniform(-0.5, 0.5));
    const SpaceLine moved = movedLine(line, change);
    EXPECT_NEAR((moved.point - line.point).norm(), change.head<2>().norm(), 1e-12);
    EXPECT_NEAR((moved.point - line.point).dot(line.direction), 0, 1e-12);
    EXPECT_NEAR(moved.direction.norm(), 1, 1e-12);
    EXPECT_NEAR(std::tan(std::acos(std::min(1.0, moved.direction.dot(line.direction)))), change.tail<2>().norm(), 1e-7);
    // The change can be read from where the line is then.
    const LineBasis basis = lineBasis(line.direction);
    EXPECT_TRUE((basis.transpose() * (moved.point - line.point)).isApprox(change.head<2>(), 1e-9));
    EXPECT_TRUE(
        (basis.transpose() * moved.direction / moved.direction.dot(line.direction)).isApprox(change.tail<2>(), 1e-9));
  }
}

TEST(SpaceLine, NoChangeLeavesItThere) {
  Random random(3);
  const SpaceLine line = randomLine(random), moved = movedLine(line, Eigen::Vector4d::Zero());
  EXPECT_EQ(moved.point, line.point);
  EXPECT_TRUE(moved.direction.isApprox(line.direction, 1e-15));
}

TEST(SpaceLine, DistanceAlongRayIsToTheNearestPoint) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const SpaceLine line = randomLine(random);
    const Eigen::Vector3d origin = random.vector(5), ray = random.direction();
    const auto gapAt = [&](double distance) {
      const Eigen::Vector3d x = origin + distance * ray;
      return (closestPoint(line, x) - x).norm();
    };
    const double distance = distanceAlongRay(line, origin, ray);
    ASSERT_TRUE(std::isfinite(distance));
    for (const double aside : {-1.0, -0.01, 0.01, 1.0}) EXPECT_LE(gapAt(distance), gapAt(distance + aside));
  }
}

TEST(SpaceLine, RayToOneOfItsPointsMeetsItThere) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const SpaceLine line = randomLine(random);
    const Eigen::Vector3d origin = random.vector(5);
    const Eigen::Vector3d to_point = line.point + random.uniform(-2, 2) * line.direction - origin;
    const double distance = to_point.norm();
    EXPECT_NEAR(distanceAlongRay(line, origin, to_point / distance), distance, 1e-6 * distance);
    EXPECT_NEAR(distanceAlongRay(line, origin, -to_point / distance), -distance, 1e-6 * distance);
  }
}

TEST(SpaceLine, ParallelRayHasNoNearestPoint) {
  Random random(6);
  for (int i = 0; i < 20; ++i) {
    const SpaceLine line = randomLine(random);
    EXPECT_TRUE(std::isnan(distanceAlongRay(line, random.vector(5), line.direction)));
    EXPECT_TRUE(std::isnan(distanceAlongRay(line, random.vector(5), -line.direction)));
  }
  EXPECT_TRUE(std::isnan(distanceAlongRay(SpaceLine(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero())));
}

TEST(SpaceLine, ClosestPointIsOnItAndSquareToIt) {
  Random random(7);
  for (int i = 0; i < 100; ++i) {
    const SpaceLine line = randomLine(random);
    const Eigen::Vector3d x = random.vector(5), closest = closestPoint(line, x);
    EXPECT_NEAR((closest - line.point).cross(line.direction).norm(), 0, 1e-12);
    EXPECT_NEAR((x - closest).dot(line.direction), 0, 1e-12);
  }
}

}  // namespace
}  // namespace edgeslam
