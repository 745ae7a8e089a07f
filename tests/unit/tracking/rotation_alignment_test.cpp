// The rotation between two frames from their small images.
#include "tracking/rotation_alignment.h"

#include <gtest/gtest.h>

#include "geometry/camera_mask.h"
#include "geometry/pose.h"
#include "unit/tracking/textured_plane.h"

namespace edgeslam {
namespace {

// A far plane of coarse texture: turning is all that shows.
TexturedPlane farPlane() {
  TexturedPlane plane{SmoothTexture(53)};
  plane.grain = 4;
  return plane;
}

double errorAfter(const Eigen::Vector3d& turn, const Eigen::Quaterniond& start, double brightness = 0) {
  const Camera camera = smallCamera();
  const TexturedPlane plane = farPlane();
  const Pose turned{rotationExp(turn), Eigen::Vector3d::Zero()};
  const cv::Mat first = plane.render(camera, Pose());
  cv::Mat second = plane.render(camera, turned);
  second.convertTo(second, CV_8U, 1.0, brightness);
  const ImagePyramid from = buildPyramid(first, 6), to = buildPyramid(second, 6);
  const Eigen::Quaterniond found = alignRotation(camera, makeRotationGrids(camera), from, to, start);
  return rotationAngle(found, turned.rotation.conjugate());
}

TEST(RotationAlignment, FindsTurnsThatConstantVelocityDoesNotForesee) {
  for (const Eigen::Vector3d& turn : {Eigen::Vector3d(0.05, 0, 0), Eigen::Vector3d(0, -0.08, 0),
                                      Eigen::Vector3d(0, 0, 0.07), Eigen::Vector3d(0.03, 0.04, -0.05)}) {
    EXPECT_LT(errorAfter(turn, Eigen::Quaterniond::Identity()), 0.15 * turn.norm()) << turn.transpose();
  }
}

TEST(RotationAlignment, StaysWhereItIsRight) {
  const Eigen::Vector3d turn(0.02, 0.05, 0);
  EXPECT_LT(errorAfter(turn, rotationExp(turn).conjugate()), 0.004);
}

TEST(RotationAlignment, BrightnessDoesNotMatter) {
  EXPECT_LT(errorAfter({0, 0.06, 0}, Eigen::Quaterniond::Identity(), 15), 0.01);
}

TEST(RotationAlignment, AFlatImageLeavesTheStart) {
  const Camera camera = smallCamera();
  const ImagePyramid flat = buildPyramid(cv::Mat(camera.height, camera.width, CV_8U, cv::Scalar(90)), 6);
  const Eigen::Quaterniond start = rotationExp({0.01, 0.02, 0.03});
  EXPECT_EQ(alignRotation(camera, makeRotationGrids(camera), flat, flat, start).coeffs(), start.coeffs());
}

TEST(RotationAlignment, GridsAreRenewedForAnotherCameraInPlace) {
  Camera longer = smallCamera();
  longer.fx *= 1.2;
  longer.fy *= 1.2;
  std::vector<RotationGrid> renewed = makeRotationGrids(smallCamera());
  const RotationGrid::Sample* const place = renewed.front().samples.data();
  renewRotationGrids(longer, renewed);
  EXPECT_EQ(renewed.front().samples.data(), place);
  const std::vector<RotationGrid> made = makeRotationGrids(longer);
  ASSERT_EQ(renewed.size(), made.size());
  for (std::size_t i = 0; i < made.size(); ++i) {
    ASSERT_EQ(renewed[i].samples.size(), made[i].samples.size());
    for (std::size_t k = 0; k < made[i].samples.size(); ++k) {
      EXPECT_EQ(renewed[i].samples[k].bearing, made[i].samples[k].bearing);
      EXPECT_EQ(renewed[i].samples[k].pixel_by_rotation, made[i].samples[k].pixel_by_rotation);
    }
  }
}

// A plate of the robot turns with the camera and says that it stands still.
TEST(RotationAlignment, WhatIsMaskedDoesNotCount) {
  Camera camera = smallCamera();
  const Pose turned{rotationExp({0, 0.06, 0}), Eigen::Vector3d::Zero()};
  const cv::Mat plate = SmoothTexture(9).render({camera.width, 90}, [](const Eigen::Vector2d& p) { return p / 4; });
  const auto pyramidAt = [&](const Pose& pose) {
    cv::Mat image = farPlane().render(camera, pose);
    plate.copyTo(image.rowRange(0, plate.rows));
    return buildPyramid(image, 6);
  };
  const auto error = [&] {
    const Eigen::Quaterniond start = Eigen::Quaterniond::Identity();
    const auto found = alignRotation(camera, makeRotationGrids(camera), pyramidAt(Pose()), pyramidAt(turned), start);
    return rotationAngle(found, turned.rotation.conjugate());
  };
  EXPECT_GT(error(), 0.03) << "the case is no test of the mask";
  cv::Mat mask(camera.height, camera.width, CV_8U, cv::Scalar(255));
  mask.rowRange(0, plate.rows).setTo(0);
  camera.mask = makeCameraMask(mask);
  EXPECT_LT(error(), 0.01);
}

}  // namespace
}  // namespace edgeslam
