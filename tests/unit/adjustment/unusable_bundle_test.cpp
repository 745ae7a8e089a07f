// P19: what bundle adjustment does with problems that have no answer, or a wrong part.
#include <gtest/gtest.h>

#include <limits>

#include "adjustment/bundle_adjustment.h"
#include "synthetic_bundle.h"

namespace edgeslam::test {
namespace {

TEST(UnusableBundle, NothingToAdjustIsNotUsable) {
  Random random(12);
  BundleProblem empty;
  EXPECT_FALSE(adjustBundle(testCamera(CameraModel::kannala_brandt), empty, {}).usable);

  BundleScene scene = makeBundleScene(random, {});
  for (BundleCamera& c : scene.truth.cameras) c.fixed = true;
  for (BundlePoint& p : scene.truth.points) p.fixed = true;
  const BundleResult result = adjustBundle(scene.camera, scene.truth, {});
  EXPECT_FALSE(result.usable);
  ASSERT_EQ(result.errors.size(), scene.truth.observations.size());
  for (const double error : result.errors) EXPECT_LT(error, 1e-6);
}

TEST(UnusableBundle, IndicesOutOfRangeLeaveTheProblem) {
  Random random(13);
  const BundleScene scene = makeBundleScene(random, {});
  const BundleProblem good = perturbedProblem(random, scene.truth, 0.05, 0.02);
  for (const int bad : {-1, 1000000}) {
    for (int what = 0; what < 5; ++what) {
      BundleProblem problem = good;
      if (what == 0) problem.observations[3].camera = bad;
      if (what == 1) problem.observations[3].point = bad;
      if (what == 2) problem.points[3].host = bad;
      if (what == 3) problem.scale_camera = 1000000;
      if (what == 4) problem.scale_cameras = {1, bad};
      const BundleResult result = adjustBundle(scene.camera, problem, {});
      EXPECT_FALSE(result.usable);
      EXPECT_TRUE(sameBytes(problem, good));
      EXPECT_EQ(result.errors.size(), problem.observations.size());
      EXPECT_EQ(result.depth_sigmas.size(), problem.points.size());
    }
  }
}

TEST(UnusableBundle, ValuesThatAreNoNumbersTakeNoPart) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Random random(14);
  const BundleScene scene = makeBundleScene(random, {});
  BundleProblem problem = perturbedProblem(random, scene.truth, 0.05, 0.02);
  problem.observations[0].measurement.pixel.x() = nan;
  problem.observations[1].measurement.pixel.y() = kInfinity;
  problem.observations[2].measurement.sigma_normal = 0;
  problem.observations[3].measurement.normal.setConstant(nan);
  problem.points[20].inverse_depth = nan;
  problem.points[21].inverse_depth = -1;
  problem.points[22].host_bearing.x() = nan;
  problem.points[23].prior_sigma = nan;
  const BundleResult result = adjustBundle(scene.camera, problem, manyIterations());
  ASSERT_TRUE(result.usable);
  EXPECT_LT(largestTranslationError(problem, scene.truth), 1e-6);
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    const int point = problem.observations[i].point;
    if (i < 4 || (point >= 20 && point <= 23)) {
      EXPECT_EQ(result.errors[i], kInfinity) << i;
    } else {
      EXPECT_LT(result.errors[i], 1e-3) << i;
    }
  }

  BundleProblem lost = perturbedProblem(random, scene.truth, 0.05, 0.02);
  lost.cameras[4].world_T_camera.translation.x() = nan;
  const double depth = lost.points[0].inverse_depth;
  EXPECT_FALSE(adjustBundle(scene.camera, lost, {}).usable);
  EXPECT_EQ(lost.points[0].inverse_depth, depth);
}

// What tells nothing of depth or place must end finite, or be refused with the problem as it was.
TEST(UnusableBundle, DegenerateProblemsEndFiniteOrAreRefused) {
  Random random(17);
  const BundleScene scene = makeBundleScene(random, {});
  for (int what = 0; what < 5; ++what) {
    BundleProblem problem = perturbedProblem(random, scene.truth, 0.02, 0.01);
    bool nothing_to_adjust = false;
    if (what == 0) {  // one keyframe alone
      problem.cameras.resize(1);
      problem.cameras[0].fixed = false;
      for (BundlePoint& p : problem.points) p.host = 0;
      for (BundleObservation& o : problem.observations) o.camera = 0;
      nothing_to_adjust = true;
    }
    if (what == 1) {  // no parallax at all
      for (BundleCamera& c : problem.cameras) c.world_T_camera.translation.setZero();
    }
    if (what == 2) {  // all at infinity
      for (BundlePoint& p : problem.points) p.inverse_depth = 1e-300;
    }
    if (what == 3) {  // nothing fixed, one observation
      for (BundleCamera& c : problem.cameras) c.fixed = false;
      problem.observations.resize(1);
    }
    if (what == 4) {  // all in the same place of the image
      for (BundleObservation& o : problem.observations) o.measurement.pixel.setConstant(100);
      for (BundlePoint& p : problem.points) p.host_bearing = Eigen::Vector3d::UnitZ();
    }
    const BundleProblem before = problem;
    const BundleResult result = adjustBundle(scene.camera, problem, manyIterations());
    EXPECT_TRUE(result.usable || sameBytes(problem, before)) << what;
    if (nothing_to_adjust) {
      EXPECT_FALSE(result.usable);
    }
    EXPECT_LE(result.final_cost, result.initial_cost * (1 + 1e-9)) << what;
    for (const BundleCamera& c : problem.cameras) {
      EXPECT_TRUE(c.world_T_camera.translation.allFinite() && c.world_T_camera.rotation.coeffs().allFinite()) << what;
    }
    for (const BundlePoint& p : problem.points) EXPECT_TRUE(std::isfinite(p.inverse_depth) && p.inverse_depth > 0);
    for (const double sigma : result.depth_sigmas) EXPECT_TRUE(std::isfinite(sigma));
  }
}

TEST(UnusableBundle, InterruptedLeavesTheProblem) {
  Random random(18);
  const BundleScene scene = makeBundleScene(random, {});
  BundleProblem problem = perturbedProblem(random, scene.truth, 0.02, 0.01);
  const BundleProblem before = problem;
  const std::atomic<bool> interrupted{true};
  EXPECT_FALSE(adjustBundle(scene.camera, problem, {}, &interrupted).usable);
  EXPECT_TRUE(sameBytes(problem, before));
}

TEST(UnusableBundle, PointsBehindTheCameraNeitherPullNorBlock) {
  Random random(15);
  const BundleScene scene = makeBundleScene(random, {});
  BundleProblem problem = scene.truth;
  // A camera turned away sees nothing of what it is said to see.
  const int turned = static_cast<int>(problem.cameras.size());
  BundleCamera camera = problem.cameras[0];
  camera.world_T_camera.rotation = rotationExp({0, M_PI, 0});
  camera.fixed = true;
  problem.cameras.push_back(camera);
  BundleProblem truth = problem;
  problem = perturbedProblem(random, problem, 0.05, 0.02);
  for (int k = 0; k < 30; ++k) {
    BundleObservation o;
    o.camera = turned;
    o.point = k;
    o.measurement = measure(random, randomPixel(random, scene.camera), 0, 0.5, 0.5, 0);
    problem.observations.push_back(o);
  }
  BundleProblem adjusted = problem;
  const BundleResult result = adjustBundle(scene.camera, adjusted, manyIterations());
  ASSERT_TRUE(result.usable);
  EXPECT_LT(largestTranslationError(adjusted, truth), 1e-4);
  for (std::size_t i = problem.observations.size() - 30; i < problem.observations.size(); ++i) {
    EXPECT_EQ(result.errors[i], std::numeric_limits<double>::infinity());
  }
}

}  // namespace
}  // namespace edgeslam::test
