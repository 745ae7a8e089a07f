#include "adjustment/line_residual.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "synthetic_scene.h"

namespace edgeslam::test {
namespace {

struct SeenLine {
  SpaceLine line;
  Pose world_T_camera;
  Eigen::Vector3d bearing;  // camera frame
  double sigma = 1e-3;
};

// Seen with an error of some degrees.
SeenLine seenLine(Random& random) {
  SeenLine seen;
  seen.line = {uniformVector(random, 4), direction(random)};
  seen.world_T_camera = randomPose(random, 4, 3);
  seen.sigma = uniform(random, 1e-3, 1);
  const Eigen::Vector3d on_line = seen.line.point + uniform(random, -1, 1) * seen.line.direction;
  seen.bearing = ((seen.world_T_camera.inverse() * on_line).normalized() + 0.1 * uniformVector(random, 1)).normalized();
  return seen;
}

bool residualOf(const SeenLine& seen, double& residual, LineDerivatives* derivatives = nullptr) {
  return lineResidual(seen.line, seen.world_T_camera.translation, seen.world_T_camera.rotation * seen.bearing,
                      seen.sigma, residual, derivatives);
}

// By three numbers that `change` moves a seen line by.
Eigen::Vector3d numericDerivative(const SeenLine& seen,
                                  const std::function<void(SeenLine&, const Eigen::Vector3d&)>& change) {
  constexpr double kStep = 1e-6;
  Eigen::Vector3d derivative;
  for (int i = 0; i < 3; ++i) {
    SeenLine after = seen, before = seen;
    change(after, kStep * Eigen::Vector3d::Unit(i));
    change(before, -kStep * Eigen::Vector3d::Unit(i));
    double residual_after = 0, residual_before = 0;
    EXPECT_TRUE(residualOf(after, residual_after) && residualOf(before, residual_before));
    derivative(i) = (residual_after - residual_before) / (2 * kStep);
  }
  return derivative;
}

TEST(LineResidual, IsTheAngleToThePlaneThroughCameraAndLine) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    SeenLine seen = seenLine(random);
    const Eigen::Vector3d& centre = seen.world_T_camera.translation;
    const Eigen::Vector3d from = (seen.line.point - centre).normalized();
    const Eigen::Vector3d normal = from.cross(seen.line.direction).normalized();
    const double angle = uniform(random, -0.5, 0.5);
    seen.bearing = seen.world_T_camera.rotation.conjugate() * (std::cos(angle) * from + std::sin(angle) * normal);
    double residual = 0;
    ASSERT_TRUE(residualOf(seen, residual));
    EXPECT_NEAR(residual, std::sin(angle) / seen.sigma, 1e-9 / seen.sigma);
    // Where along the line it is seen, and which of its points stands for it, is the same.
    seen.line.point += uniform(random, -2, 2) * seen.line.direction;
    double same = 0;
    ASSERT_TRUE(residualOf(seen, same));
    EXPECT_NEAR(same, residual, 1e-9 / seen.sigma);
  }
}

TEST(LineResidual, DerivativesMatchDifferences) {
  Random random(2);
  int checked = 0;
  for (int i = 0; i < 200; ++i) {
    const SeenLine seen = seenLine(random);
    const Eigen::Vector3d to_point = seen.line.point - seen.world_T_camera.translation;
    if (to_point.cross(seen.line.direction).norm() < 0.2) continue;  // too bent for differences
    double residual = 0;
    LineDerivatives derivatives;
    ASSERT_TRUE(residualOf(seen, residual, &derivatives));
    const double tolerance = 1e-5 * (1 + derivatives.by_point.norm() + derivatives.by_direction.norm());
    const auto by_point =
        numericDerivative(seen, [](SeenLine& s, const Eigen::Vector3d& change) { s.line.point += change; });
    EXPECT_LT((derivatives.by_point - by_point).norm(), tolerance);
    const auto by_centre = numericDerivative(
        seen, [](SeenLine& s, const Eigen::Vector3d& change) { s.world_T_camera.translation += change; });
    EXPECT_LT((derivatives.by_point + by_centre).norm(), tolerance);
    const auto by_turn = numericDerivative(seen, [](SeenLine& s, const Eigen::Vector3d& turn) {
      s.world_T_camera.rotation = rotationExp(turn) * s.world_T_camera.rotation;
    });
    EXPECT_LT((derivatives.by_turn - by_turn).norm(), tolerance);
    const LineBasis basis = lineBasis(seen.line.direction);
    const Eigen::Vector3d by_basis = numericDerivative(seen, [](SeenLine& s, const Eigen::Vector3d& turn) {
      s.line = movedLine(s.line, {0, 0, turn.x(), turn.y()});
    });
    EXPECT_LT((basis.transpose() * derivatives.by_direction - by_basis.head<2>()).norm(), tolerance);
    ++checked;
  }
  EXPECT_GT(checked, 150);
}

TEST(LineResidual, SeenEndOnThereIsNone) {
  Random random(3);
  for (const double beside : {0.0, 1e-9, 1e-4}) {
    SeenLine seen = seenLine(random);
    const Eigen::Vector3d across = lineBasis(seen.line.direction).col(0);
    seen.world_T_camera.translation = seen.line.point - 2 * seen.line.direction + beside * across;
    double residual = 7;
    LineDerivatives derivatives;
    EXPECT_FALSE(residualOf(seen, residual, &derivatives)) << beside;
    EXPECT_EQ(residual, 7);
    seen.world_T_camera.translation = seen.line.point;
    EXPECT_FALSE(residualOf(seen, residual));
    seen.world_T_camera.translation = seen.line.point - 2 * seen.line.direction + 0.01 * across;
    EXPECT_TRUE(residualOf(seen, residual));
    seen.line.point.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(residualOf(seen, residual));
  }
}

}  // namespace
}  // namespace edgeslam::test
