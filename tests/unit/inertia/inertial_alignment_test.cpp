#include "inertia/inertial_alignment.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

InertialAlignment alignmentOf(const Eigen::Vector3d& gravity) {
  InertialAlignment alignment;
  alignment.is_known = true;
  alignment.metres_a_unit = 3;
  alignment.gravity = gravity;
  return alignment;
}

TEST(InertialAlignment, UprightIsWithGravityDownwards) {
  for (const Eigen::Vector3d& gravity :
       {Eigen::Vector3d(0.1, 9.7, 1.2), Eigen::Vector3d(-4, 0, -9), Eigen::Vector3d(0, 0, -9.8)}) {
    const Eigen::Vector3d turned = uprightRotation(alignmentOf(gravity)) * gravity;
    EXPECT_NEAR((turned - Eigen::Vector3d(0, 0, -gravity.norm())).norm(), 0, 1e-12);
  }
}

TEST(InertialAlignment, UprightTurnsAboutAHorizontalAxisOnly) {
  const Eigen::Vector3d gravity(0.1, 9.7, 1.2);
  const Eigen::Vector3d axis = rotationLog(uprightRotation(alignmentOf(gravity)));
  EXPECT_NEAR(axis.dot(gravity), 0, 1e-12);
  EXPECT_NEAR(axis.z(), 0, 1e-12);
}

TEST(InertialAlignment, OfAMovedMapLeavesLengthsInMetresAndGravityWhereTheyAre) {
  const Similarity new_S_old{2.5, rotationExp({0.3, -1.2, 0.7}), Eigen::Vector3d(4, 5, 6)};
  const InertialAlignment before = alignmentOf({1, -2, 9});
  const InertialAlignment after = moved(new_S_old, before);
  const Eigen::Vector3d a(1, 2, 3), b(-2, 0.5, 8);
  const double length_m = before.metres_a_unit * (a - b).norm();
  EXPECT_NEAR(after.metres_a_unit * (new_S_old * a - new_S_old * b).norm(), length_m, 1e-12);
  // A plumb line stays one.
  const Eigen::Vector3d down = (new_S_old * Eigen::Vector3d(a + before.gravity) - new_S_old * a).normalized();
  EXPECT_NEAR((after.gravity.normalized() - down).norm(), 0, 1e-12);
  EXPECT_NEAR(after.gravity.norm(), before.gravity.norm(), 1e-12);
}

}  // namespace
}  // namespace edgeslam
