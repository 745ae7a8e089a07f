#include "scale/gradual_scale.h"

#include <gtest/gtest.h>

#include <cmath>

namespace edgeslam {
namespace {

TEST(GradualScale, IsUnknownUntilItIsKnownWellEnoughAndThenMovesByTheStep) {
  GradualScale gradual(0.1);
  gradual.follow({std::log(2), 0.15, ""}, ScaleKind::odometry);
  EXPECT_EQ(gradual.scale().kind, ScaleKind::unknown);
  gradual.follow({std::log(2), 0.05, "only 3 of 9"}, ScaleKind::odometry);
  EXPECT_EQ(gradual.scale().kind, ScaleKind::unknown);
  gradual.follow({std::log(2), 0.05, ""}, ScaleKind::odometry);
  EXPECT_EQ(gradual.scale().kind, ScaleKind::odometry);
  EXPECT_DOUBLE_EQ(gradual.scale().metres_per_unit, 2);
  EXPECT_DOUBLE_EQ(gradual.scale().sigma, 0.05);

  double before = 2;
  for (int i = 0; i < 100; ++i) {
    gradual.follow({std::log(2.1), 0.02, ""}, ScaleKind::odometry);
    EXPECT_LE(std::abs(std::log(gradual.scale().metres_per_unit / before)), GradualScale::largest_step + 1e-12);
    EXPECT_GE(gradual.scale().sigma, std::abs(std::log(gradual.scale().metres_per_unit / 2.1)));
    before = gradual.scale().metres_per_unit;
  }
  EXPECT_NEAR(before, 2.1, 1e-9);
  EXPECT_NEAR(gradual.scale().sigma, 0.02, 1e-9);
}

TEST(GradualScale, AContradictionMovesNothingAndIsTold) {
  GradualScale gradual(0.1);
  gradual.follow({0, 0.05, ""}, ScaleKind::camera_height);
  gradual.follow({0.3, 0.2, "only 5 of 9"}, ScaleKind::camera_height);
  EXPECT_DOUBLE_EQ(gradual.scale().metres_per_unit, 1);
  EXPECT_GT(gradual.scale().sigma, 0.3);
  EXPECT_EQ(gradual.scale().kind, ScaleKind::camera_height) << "lengths stay metres";
  gradual.follow({0.0, 0.05, ""}, ScaleKind::camera_height);
  EXPECT_DOUBLE_EQ(gradual.scale().sigma, 0.05);
  gradual.forget();
  EXPECT_EQ(gradual.scale().kind, ScaleKind::unknown);
}

}  // namespace
}  // namespace edgeslam
