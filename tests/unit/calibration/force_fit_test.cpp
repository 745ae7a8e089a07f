// The accelerometer's bias and the lever arm from a camera's way.
#include "calibration/force_fit.h"

#include <gtest/gtest.h>

#include "unit/inertia/turning_camera.h"

namespace edgeslam::test {
namespace {

// As known before: its place is not.
InertialUnit unitOf(const TurningCamera& camera) {
  InertialUnit unit;
  unit.imu_T_camera.rotation = camera.imu_R_camera;
  unit.offset_ns = std::llround(camera.offset_s * 1e9);
  return unit;
}

std::optional<ForceFit> fitted(const TurningCamera& camera, unsigned seed = 1) {
  return fitForces(camera.poses(seed), camera.samples(seed), unitOf(camera), Eigen::Matrix3d::Zero(), camera.rate_bias);
}

TEST(ForceFit, FindsBiasPlaceAndScaleWithinThreeStandardDeviations) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const TurningCamera camera;
    const auto fit = fitted(camera, seed);
    ASSERT_TRUE(fit);
    EXPECT_TRUE(fit->tells_bias && fit->tells_place);
    EXPECT_LT((fit->bias - camera.force_bias).cwiseQuotient(fit->bias_sigma).cwiseAbs().maxCoeff(), 3) << seed;
    EXPECT_LT((fit->imu_t_camera - camera.imu_t_camera).cwiseQuotient(fit->imu_t_camera_sigma).cwiseAbs().maxCoeff(), 3)
        << seed;
    EXPECT_NEAR(fit->metres_a_unit, camera.metres_a_unit, 3 * fit->scale_sigma * camera.metres_a_unit);
    EXPECT_LT(fit->imu_t_camera_sigma.maxCoeff(), 0.005);
  }
}

// The rotation is off by a degree: so is gravity.
TEST(ForceFit, ARotationThatErrsIsInTheDeviationOfTheBias) {
  const TurningCamera camera;
  const Eigen::Vector3d off = radians(1) * Eigen::Vector3d(0.6, 0, 0.8);
  InertialUnit unit = unitOf(camera);
  unit.imu_T_camera.rotation = unit.imu_T_camera.rotation * rotationExp(off);
  const auto fit = fitForces(camera.poses(1), camera.samples(1), unit, off * off.transpose(), camera.rate_bias);
  ASSERT_TRUE(fit);
  const Eigen::Vector3d error = fit->bias - camera.force_bias;
  EXPECT_GT(error.norm(), 0.03) << "some of it is taken for a bias";
  EXPECT_LT(error.cwiseQuotient(fit->bias_sigma).cwiseAbs().maxCoeff(), 2) << error.transpose();
}

TEST(ForceFit, ACameraThatHardlyMovesTellsNoPlace) {
  TurningCamera camera;
  camera.swing_m = {0.002, 0.002, 0.002};
  camera.swing_rad *= 0.2;
  const auto fit = fitted(camera);
  EXPECT_FALSE(fit && fit->tells_place);
}

TEST(ForceFit, OfTwoWorldsTheLongerOneCounts) {
  const TurningCamera camera;
  std::vector<PosedCamera> poses = camera.poses(1);
  for (std::size_t i = 0; i < poses.size() / 4; ++i) {
    poses[i].world = 1;
    poses[i].world_T_camera = Pose{rotationExp({1, 0, 0}), Eigen::Vector3d::Zero()} * poses[i].world_T_camera;
    poses[i].world_T_camera.translation *= 3;
  }
  const auto fit = fitForces(poses, camera.samples(1), unitOf(camera), Eigen::Matrix3d::Zero(), camera.rate_bias);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->metres_a_unit, camera.metres_a_unit, 0.05 * camera.metres_a_unit);
}

TEST(ForceFit, OfTooLittleOrOfOtherUnitsIsNone) {
  TurningCamera camera;
  std::vector<InertialSample> in_multiples_of_g = camera.samples(1);
  for (InertialSample& sample : in_multiples_of_g) sample.force /= standard_gravity;
  EXPECT_FALSE(
      fitForces(camera.poses(1), in_multiples_of_g, unitOf(camera), Eigen::Matrix3d::Zero(), camera.rate_bias));
  EXPECT_FALSE(fitForces({}, camera.samples(1), unitOf(camera), Eigen::Matrix3d::Zero(), camera.rate_bias));
  camera.seconds = 2;
  EXPECT_FALSE(fitted(camera));
}

}  // namespace
}  // namespace edgeslam::test
