// Camera models: projection, its derivative, and bearings that invert it.
#include "geometry/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/geometry/scene_fixture.h"

namespace edgeslam {
namespace {

class EveryCamera : public testing::TestWithParam<NamedCamera> {};

INSTANTIATE_TEST_SUITE_P(Calibrations, EveryCamera, testing::ValuesIn(cameras()),
                         [](const auto& tested) { return tested.param.name; });
INSTANTIATE_TEST_SUITE_P(FoldingCalibrations, EveryCamera, testing::ValuesIn(foldingCameras()),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(EveryCamera, BearingIsUnitAndProjectsBackOverTheWholeImage) {
  const Camera& camera = GetParam().camera;
  for (double y = 0; y <= camera.height - 1; y += (camera.height - 1) / 48.0) {
    for (double x = 0; x <= camera.width - 1; x += (camera.width - 1) / 64.0) {
      const Eigen::Vector3d ray = bearing(camera, {x, y});
      ASSERT_NEAR(ray.norm(), 1, 1e-12);
      ASSERT_LT((project(camera, ray) - Eigen::Vector2d(x, y)).norm(), 1e-8) << x << ", " << y;
    }
  }
}

TEST_P(EveryCamera, BearingInvertsProjectionInAngle) {
  const Camera& camera = GetParam().camera;
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d ray = bearing(camera, randomPixel(camera, random));
    EXPECT_LT(angleBetween(bearing(camera, project(camera, random.uniform(0.1, 100) * ray)), ray), 1e-10);
  }
}

TEST_P(EveryCamera, PrincipalPointLooksAhead) {
  const Camera& camera = GetParam().camera;
  const Eigen::Vector2d principal(camera.cx, camera.cy);
  EXPECT_LT((bearing(camera, principal) - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((project(camera, {0, 0, 2}) - principal).norm(), 1e-12);
}

Eigen::Matrix<double, 2, 3> numericJacobian(const Camera& camera, const Eigen::Vector3d& point) {
  Eigen::Matrix<double, 2, 3> jacobian;
  const double step = 1e-6 * point.norm();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d offset = step * Eigen::Vector3d::Unit(k);
    jacobian.col(k) = (project(camera, point + offset) - project(camera, point - offset)) / (2 * step);
  }
  return jacobian;
}

TEST_P(EveryCamera, JacobianMatchesNumericOne) {
  const Camera& camera = GetParam().camera;
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d point = random.uniform(0.2, 20) * bearing(camera, randomPixel(camera, random));
    Eigen::Matrix<double, 2, 3> jacobian;
    const Eigen::Vector2d pixel = project(camera, point, &jacobian);
    EXPECT_EQ(pixel, project(camera, point));
    EXPECT_LT((jacobian - numericJacobian(camera, point)).norm(), 1e-6 * jacobian.norm()) << point.transpose();
    EXPECT_LT((jacobian * point).norm(), 1e-9 * jacobian.norm() * point.norm()) << "depth must not move the pixel";
  }
}

TEST_P(EveryCamera, JacobianHoldsOnTheAxisAndBesideIt) {
  const Camera& camera = GetParam().camera;
  for (const double offset : {0.0, 1e-12, 1e-9, 3e-9, 1e-7, 1e-4}) {
    const Eigen::Vector3d point(offset, -0.5 * offset, 2);
    Eigen::Matrix<double, 2, 3> jacobian;
    ASSERT_TRUE(project(camera, point, &jacobian).allFinite());
    EXPECT_LT((jacobian - numericJacobian(camera, point)).norm(), 1e-6 * jacobian.norm()) << offset;
  }
}

TEST(Camera, FisheyeSeesBehindTheImagePlane) {
  const Camera camera = fisheyeCamera();
  const double angle = 100 * degree;
  const Eigen::Vector3d ray(std::sin(angle), 0, std::cos(angle));
  ASSERT_LT(ray.z(), 0);
  EXPECT_LT(angleBetween(bearing(camera, project(camera, ray)), ray), 1e-10);
}

// Radial distortion moves pixels along their radius only, outwards where k1 is positive; tangential distortion by hand.
TEST(Camera, DistortionHasTheDocumentedMeaning) {
  Camera camera{CameraModel::pinhole_radial_tangential, 640, 480, 100, 100, 320, 240, {0.1, 0.01, 0, 0, 0.001}};
  const double radial = 1 + 0.1 * 0.25 + 0.01 * 0.0625 + 0.001 * 0.015625;  // r^2 = 0.25
  EXPECT_LT((project(camera, {0.6, 0.8, 2}) - Eigen::Vector2d(320 + 30 * radial, 240 + 40 * radial)).norm(), 1e-12);
  camera.distortion = {0, 0, 0.02, 0.03, 0};
  const Eigen::Vector2d expected(0.3 + 2 * 0.02 * 0.12 + 0.03 * (0.25 + 0.18),
                                 0.4 + 0.02 * (0.25 + 0.32) + 2 * 0.03 * 0.12);
  EXPECT_LT((project(camera, {0.6, 0.8, 2}) - (100 * expected + Eigen::Vector2d(320, 240))).norm(), 1e-12);
  const Camera fisheye{CameraModel::kannala_brandt, 640, 480, 100, 100, 320, 240, {0.1, 0.02, 0.03, 0.004, 0}};
  const double distorted = 0.5 * (1 + 0.1 * 0.25 + 0.02 * 0.0625 + 0.03 * 0.015625 + 0.004 * 0.00390625);
  EXPECT_LT((project(fisheye, {std::sin(0.5), 0, std::cos(0.5)}) - Eigen::Vector2d(320 + 100 * distorted, 240)).norm(),
            1e-12);
}

TEST(Camera, InsideImageCountsPixelCentresAndBorder) {
  const Camera camera = pinholeCamera();
  EXPECT_TRUE(insideImage(camera, {0, 0}));
  EXPECT_TRUE(insideImage(camera, {639, 479}));
  EXPECT_FALSE(insideImage(camera, {639.01, 100}));
  EXPECT_FALSE(insideImage(camera, {100, -0.01}));
  EXPECT_FALSE(insideImage(camera, {4, 100}, 5));
  EXPECT_TRUE(insideImage(camera, {5, 474}, 5));
  EXPECT_FALSE(insideImage(camera, {5, 474.01}, 5));
  EXPECT_FALSE(insideImage(camera, {std::nan(""), 100}));
}

}  // namespace
}  // namespace edgeslam
