// P19: the residual that adjustments minimise, and its derivatives.
#include "adjustment/reprojection.h"

#include <gtest/gtest.h>

#include <limits>

#include "synthetic_scene.h"

namespace edgeslam::test {
namespace {

WhitenedPixel randomWhitenedPixel(Random& random, const Camera& camera) {
  const Measurement m = measure(random, randomPixel(random, camera), uniform(random, -M_PI, M_PI),
                                uniform(random, 0.2, 2), uniform(random, 0.5, 20), 0);
  return {m.pixel, whitening(m)};
}

// A camera near the origin that looks along z, as all points of these tests want to be seen.
Pose forwardPose(Random& random) { return randomPose(random, 0.5, 0.2); }

// Column k of the derivative of a residual by a right-hand update, by central differences.
template <typename Residual>
Matrix26d numericByPose(const Pose& pose, const Residual& residual) {
  constexpr double kStep = 1e-6;
  Matrix26d derivative;
  for (int k = 0; k < 6; ++k) {
    const Vector6d update = kStep * Vector6d::Unit(k);
    derivative.col(k) = (residual(retract(pose, update)) - residual(retract(pose, -update))) / (2 * kStep);
  }
  return derivative;
}

class ReprojectionOfModel : public testing::TestWithParam<CameraModel> {};

TEST_P(ReprojectionOfModel, DerivativeByPointMatchesDifferences) {
  Random random(1);
  const Camera camera = testCamera(GetParam());
  for (int run = 0; run < 200; ++run) {
    const WhitenedPixel measured = randomWhitenedPixel(random, camera);
    const Eigen::Vector3d point = bearing(camera, randomPixel(random, camera)) * uniform(random, 0.5, 5);
    Eigen::Vector2d residual;
    Matrix23d analytic, numeric;
    ASSERT_TRUE(pointResidual(camera, measured, point, residual, &analytic));
    for (int k = 0; k < 3; ++k) {
      constexpr double kStep = 1e-6;
      Eigen::Vector2d above, below;
      ASSERT_TRUE(pointResidual(camera, measured, point + kStep * Eigen::Vector3d::Unit(k), above, nullptr));
      ASSERT_TRUE(pointResidual(camera, measured, point - kStep * Eigen::Vector3d::Unit(k), below, nullptr));
      numeric.col(k) = (above - below) / (2 * kStep);
    }
    EXPECT_LT((analytic - numeric).norm(), 1e-6 * (1 + analytic.norm())) << "run " << run;
  }
}

TEST_P(ReprojectionOfModel, PoseDerivativeMatchesDifferences) {
  Random random(2);
  const Camera camera = testCamera(GetParam());
  for (int run = 0; run < 200; ++run) {
    const WhitenedPixel measured = randomWhitenedPixel(random, camera);
    const Pose pose = randomPose(random, 3, 3);
    const Eigen::Vector3d point = pose * (bearing(camera, randomPixel(random, camera)) * uniform(random, 0.5, 5));
    Eigen::Vector2d residual;
    Matrix26d analytic;
    ASSERT_TRUE(poseResidual(camera, measured, cameraFrame(pose), point, residual, &analytic));
    const Matrix26d numeric = numericByPose(pose, [&](const Pose& moved) {
      Eigen::Vector2d r;
      EXPECT_TRUE(poseResidual(camera, measured, cameraFrame(moved), point, r, nullptr));
      return r;
    });
    EXPECT_LT((analytic - numeric).norm(), 1e-6 * (1 + analytic.norm())) << "run " << run;
  }
}

TEST_P(ReprojectionOfModel, SightDerivativeMatchesDifferences) {
  Random random(3);
  const Camera camera = testCamera(GetParam());
  for (int run = 0; run < 200; ++run) {
    const WhitenedPixel measured = randomWhitenedPixel(random, camera);
    const CameraFrame host = cameraFrame(forwardPose(random)), target = cameraFrame(forwardPose(random));
    const Eigen::Vector3d host_bearing = bearing(camera, {uniform(random, 200, 440), uniform(random, 150, 330)});
    const Eigen::Vector3d seen = sight(host, target, host_bearing, run % 10 == 0 ? 0 : uniform(random, 0.01, 0.5));
    Eigen::Vector2d residual, again;
    Matrix23d analytic;
    ASSERT_TRUE(sightResidual(camera, measured, target, seen, residual, &analytic));
    ASSERT_TRUE(sightResidual(camera, measured, target, seen, again, nullptr));
    EXPECT_EQ(residual, again);
    constexpr double kStep = 1e-6;
    Matrix23d numeric;
    for (int i = 0; i < 3; ++i) {
      Eigen::Vector2d ahead, behind;
      ASSERT_TRUE(sightResidual(camera, measured, target, seen + kStep * Eigen::Vector3d::Unit(i), ahead, nullptr));
      ASSERT_TRUE(sightResidual(camera, measured, target, seen - kStep * Eigen::Vector3d::Unit(i), behind, nullptr));
      numeric.col(i) = (ahead - behind) / (2 * kStep);
    }
    EXPECT_LT((analytic - numeric).norm(), 1e-6 * (1 + numeric.norm())) << "run " << run;
  }
}

TEST_P(ReprojectionOfModel, SightAndPoseResidualsAgree) {
  Random random(4);
  const Camera camera = testCamera(GetParam());
  for (int run = 0; run < 200; ++run) {
    const WhitenedPixel measured = randomWhitenedPixel(random, camera);
    const Pose host = forwardPose(random), target = forwardPose(random);
    const Eigen::Vector3d host_bearing = bearing(camera, {uniform(random, 200, 440), uniform(random, 150, 330)});
    const double inverse_depth = uniform(random, 0.1, 0.5);
    Eigen::Vector2d by_sight, by_pose;
    ASSERT_TRUE(sightResidual(camera, measured, cameraFrame(target),
                              sight(cameraFrame(host), cameraFrame(target), host_bearing, inverse_depth), by_sight,
                              nullptr));
    ASSERT_TRUE(
        poseResidual(camera, measured, cameraFrame(target), host * (host_bearing / inverse_depth), by_pose, nullptr));
    EXPECT_LT((by_sight - by_pose).norm(), 1e-7 * (1 + by_pose.norm()));
  }
}

TEST_P(ReprojectionOfModel, RowDerivativesMatchDifferences) {
  Random random(12);
  const Camera camera = testCamera(GetParam());
  for (int run = 0; run < 200; ++run) {
    const WhitenedPixel measured = randomWhitenedPixel(random, camera);
    const Pose pose = forwardPose(random);
    const double seconds = uniform(random, -0.02, 0.02);
    Twist twist;
    twist << uniformVector(random, 1), uniformVector(random, 3);
    const Eigen::Vector3d point = pose * (bearing(camera, randomPixel(random, camera)) * uniform(random, 1, 5));
    const auto at = [&](const Pose& moved, const Twist& moving) {
      Eigen::Vector2d residual = Eigen::Vector2d::Zero();
      Matrix26d by_pose, by_twist;
      EXPECT_TRUE(
          rowResidual(camera, measured, cameraFrame(moved), moving, seconds, point, residual, by_pose, &by_twist));
      return residual;
    };
    Eigen::Vector2d residual;
    Matrix26d by_pose, by_twist, numeric_by_twist;
    ASSERT_TRUE(rowResidual(camera, measured, cameraFrame(pose), twist, seconds, point, residual, by_pose, &by_twist));
    EXPECT_LT((by_pose - numericByPose(pose, [&](const Pose& moved) { return at(moved, twist); })).norm(),
              1e-5 * (1 + by_pose.norm()));
    constexpr double kStep = 1e-5;
    for (int k = 0; k < 6; ++k) {
      const Twist change = kStep * Twist::Unit(k);
      numeric_by_twist.col(k) = (at(pose, twist + change) - at(pose, twist - change)) / (2 * kStep);
    }
    EXPECT_LT((by_twist - numeric_by_twist).norm(), 1e-5 * (1 + by_twist.norm()));
    const Pose in_row = pose * movedFor(twist, seconds);
    Eigen::Vector2d as_seen_there;
    ASSERT_TRUE(poseResidual(camera, measured, cameraFrame(in_row), point, as_seen_there, nullptr));
    EXPECT_LT((residual - as_seen_there).norm(), 1e-9 * (1 + residual.norm()));
  }
}

INSTANTIATE_TEST_SUITE_P(Models, ReprojectionOfModel,
                         testing::Values(CameraModel::pinhole_radial_tangential, CameraModel::kannala_brandt));

TEST(Reprojection, OnlyTheFisheyeSeesSideways) {
  const Camera pinhole = testCamera(CameraModel::pinhole_radial_tangential);
  const Camera fisheye = testCamera(CameraModel::kannala_brandt);
  EXPECT_TRUE(inFront(pinhole, {0, 0, 1e-9}));
  EXPECT_FALSE(inFront(pinhole, {1, 0, 0}));
  EXPECT_TRUE(inFront(fisheye, {1, 0, 0}));
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Camera& camera : {pinhole, fisheye}) {
    EXPECT_FALSE(inFront(camera, {0, 0, -1}));
    EXPECT_FALSE(inFront(camera, {0, 0, 0}));
    EXPECT_FALSE(inFront(camera, {0, nan, 1}));
    EXPECT_FALSE(inFront(camera, {0, 0, nan}));
  }
}

TEST(Reprojection, HuberWeightIsTheLossDerivative) {
  for (const double norm : {0.1, 0.9, 1.1, 3.0, 100.0}) {
    constexpr double kStep = 1e-5;
    const double derivative =
        (huberLoss((norm + kStep) * (norm + kStep), 1) - huberLoss((norm - kStep) * (norm - kStep), 1)) / (2 * kStep);
    EXPECT_NEAR(derivative, 2 * norm * huberWeight(norm, 1), 1e-6) << norm;
  }
}

}  // namespace
}  // namespace edgeslam::test
