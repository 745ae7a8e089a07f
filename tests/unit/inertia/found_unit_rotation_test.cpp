#include "inertia/found_unit_rotation.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

TEST(FoundUnitRotation, TurnsTheUnitAndLeavesWhereTheCameraIs) {
  InertialUnit unit;
  unit.imu_T_camera = {rotationExp({0.1, 0.2, 0.3}), {0.03, -0.01, 0.005}};
  unit.offset_ns = 7;
  const FoundUnitRotation found{rotationExp({0.1, 0.23, 0.3}), 1e-3};
  const InertialUnit turned = turnedAsFound(unit, found);
  EXPECT_EQ(turned.imu_T_camera.rotation.coeffs(), found.imu_R_camera.coeffs());
  EXPECT_EQ(turned.imu_T_camera.translation, unit.imu_T_camera.translation);
  EXPECT_EQ(turned.offset_ns, 7);
  EXPECT_EQ(turnedAsFound(unit, std::nullopt).imu_T_camera.rotation.coeffs(), unit.imu_T_camera.rotation.coeffs());
}

}  // namespace
}  // namespace edgeslam
