#include "geometry/distortion_reach.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "unit/geometry/scene_fixture.h"

namespace edgeslam {
namespace {

Camera withItsReach(Camera camera) {
  camera.distortion_reach = distortionReach(camera);
  return camera;
}

TEST(DistortionReach, CalibrationsReachTheCornersAndOnesThatFoldTheImageDoNot) {
  for (const NamedCamera& named : cameras()) {
    EXPECT_TRUE(reachesCorners(named.camera)) << named.name;
    for (const double folding : {-1.0, -3.0, -1e6, std::nan("")}) {
      Camera folded = named.camera;
      folded.distortion = {folding, 0, 0, 0, 0};
      EXPECT_FALSE(reachesCorners(folded)) << named.name << ", " << folding;
    }
  }
  for (const NamedCamera& named : foldingCameras()) EXPECT_FALSE(reachesCorners(named.camera)) << named.name;
}

// The Kinect's, as others have calibrated it: without its last coefficient its corners are images of nothing.
TEST(DistortionReach, AllCoefficientsCount) {
  Camera kinect = pinholeCamera();
  kinect.distortion = {0.2624, -0.9531, -0.0054, 0.0026, 1.1633};
  EXPECT_EQ(distortionReach(kinect), std::numeric_limits<double>::infinity());
  kinect.distortion[4] = 0;
  EXPECT_FALSE(reachesCorners(kinect));
}

TEST(DistortionReach, TheFarthestCornerIsThatFarthestFromTheCentre) {
  Camera camera = pinholeCamera();
  camera.cx = 0;
  EXPECT_NEAR(farthestCorner(camera) * camera.fx,
              std::hypot(camera.width - 1, std::max(camera.cy, camera.height - 1 - camera.cy) * camera.fx / camera.fy),
              1e-9);
}

TEST(DistortionReach, WithinItNothingChanges) {
  for (const NamedCamera& named : cameras()) {
    const Camera reaching = withItsReach(named.camera);
    Random random(1);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector2d pixel = randomPixel(named.camera, random);
      const Eigen::Vector3d ray = bearing(named.camera, pixel);
      EXPECT_EQ(bearing(reaching, pixel), ray) << named.name;
      EXPECT_EQ(project(reaching, ray), project(named.camera, ray)) << named.name;
    }
  }
}

// From the axis outwards, pixels go outwards: farther than the reach as well.
TEST(DistortionReach, WhatIsFartherFromTheAxisIsSeenFartherFromTheCentre) {
  std::vector<NamedCamera> tested = cameras();
  for (const NamedCamera& folding : foldingCameras()) tested.push_back(folding);
  for (const NamedCamera& named : tested) {
    const Camera camera = withItsReach(named.camera);
    for (int direction = 0; direction < 12; ++direction) {
      const double around = direction * 30 * degree;
      double before = 0;
      for (double angle = 1; angle <= 85; angle += 0.5) {
        const double sine = std::sin(angle * degree);
        const Eigen::Vector3d ray(sine * std::cos(around), sine * std::sin(around), std::cos(angle * degree));
        const double seen = (project(camera, ray) - Eigen::Vector2d(camera.cx, camera.cy)).norm();
        ASSERT_GT(seen, before) << named.name << ", " << direction * 30 << ", " << angle;
        before = seen;
      }
    }
  }
}

// What is fitted to what can be believed is near it there, and reaches the corners.
TEST(DistortionReach, ASimplerDistortionTakesThePlaceOfOneThatFolds) {
  const Camera camera = foldingCameras()[0].camera;
  const Camera simpler = withBelievableDistortion(camera);
  EXPECT_TRUE(reachesCorners(simpler));
  EXPECT_EQ(simpler.distortion[4], 0);
  EXPECT_EQ(simpler.distortion[2], camera.distortion[2]) << "the tangential ones stay";
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector2d pixel = randomPixel(camera, random);
    if ((pixel - Eigen::Vector2d(camera.cx, camera.cy)).norm() > 0.7 * seenAtReach(camera) * camera.fx) continue;
    EXPECT_LT((project(simpler, bearing(camera, pixel)) - pixel).norm(), 3) << pixel.transpose();
  }
}

TEST(DistortionReach, WhatReachesTheCornersAndWhatNoCoefficientDoesStays) {
  for (const NamedCamera& named : cameras()) {
    EXPECT_TRUE(withBelievableDistortion(named.camera) == named.camera) << named.name;
  }
  const Camera wide = foldingCameras()[1].camera;
  EXPECT_TRUE(withBelievableDistortion(wide) == wide);
}

// Without it, what is beside the camera seems to be in view.
TEST(DistortionReach, WhatIsOutOfViewIsSeenOutsideTheImage) {
  Camera camera = cameras()[5].camera;  // xyz
  const Eigen::Vector3d aside(1.45, 0, 1);
  EXPECT_TRUE(insideImage(camera, project(camera, aside)));
  EXPECT_FALSE(insideImage(camera, project(withItsReach(camera), aside)));
}

// The polynomial goes over into its tangent without a step or a kink.
TEST(DistortionReach, ItEndsSmoothly) {
  for (const NamedCamera& named : foldingCameras()) {
    const Camera& camera = named.camera;
    const bool is_fisheye = camera.model == CameraModel::kannala_brandt;
    const double angle = is_fisheye ? camera.distortion_reach : std::atan(camera.distortion_reach), aside = 1e-7;
    Eigen::Matrix<double, 2, 3> within, beyond;
    const Eigen::Vector2d last = project(camera, {std::sin(angle - aside), 0, std::cos(angle - aside)}, &within);
    const Eigen::Vector2d next = project(camera, {std::sin(angle + aside), 0, std::cos(angle + aside)}, &beyond);
    EXPECT_LT((next - last).norm(), 1e-3) << named.name;
    EXPECT_LT((beyond - within).norm(), 1e-5 * within.norm()) << named.name;
  }
}

}  // namespace
}  // namespace edgeslam
