// P19: bundle adjustment finds the minimum that Ceres finds, among outliers and with what is held fixed.
#include "adjustment/bundle_adjustment.h"

#include <gtest/gtest.h>

#include "adjustment/reprojection.h"
#include "ceres_bundle_adjustment.h"
#include "synthetic_bundle.h"

namespace edgeslam::test {
namespace {

class BundleAdjustmentOfModel : public testing::TestWithParam<CameraModel> {};

TEST_P(BundleAdjustmentOfModel, RecoversExactStructure) {
  Random random(1);
  for (int run = 0; run < 10; ++run) {
    BundleSceneOptions options;
    options.model = GetParam();
    const BundleScene scene = makeBundleScene(random, options);
    BundleProblem problem = perturbedProblem(random, scene.truth, 0.1, 0.05);
    const BundleResult result = adjustBundle(scene.camera, problem, manyIterations());
    ASSERT_TRUE(result.usable);
    EXPECT_LT(largestTranslationError(problem, scene.truth), 1e-6);
    EXPECT_LT(largestRotationError(problem, scene.truth), 1e-6);
    EXPECT_LT(largestDepthError(problem, scene.truth), 1e-6);
    EXPECT_LT(result.final_cost, 1e-9);
    EXPECT_GT(result.initial_cost, 100);
    EXPECT_EQ(result.errors.size(), problem.observations.size());
  }
}

TEST_P(BundleAdjustmentOfModel, KeepsTheScaleWhereOnlyOneCameraIsFixed) {
  Random random(2);
  for (int run = 0; run < 10; ++run) {
    BundleSceneOptions options;
    options.model = GetParam();
    options.fixed = 1;
    const BundleScene scene = makeBundleScene(random, options);
    BundleProblem problem = perturbedProblem(random, scene.truth, 0.1, 0.05);
    problem.scale_camera = 5;
    const auto baseline = [](const BundleProblem& p) {
      return (p.cameras[5].world_T_camera.translation - p.cameras[0].world_T_camera.translation).norm();
    };
    const double before = baseline(problem);
    ASSERT_TRUE(adjustBundle(scene.camera, problem, manyIterations()).usable);
    EXPECT_NEAR(baseline(problem), before, 1e-12);
    // The truth at the scale of the start.
    const double scale = before / baseline(scene.truth);
    BundleProblem expected = scene.truth;
    const Eigen::Vector3d origin = expected.cameras[0].world_T_camera.translation;
    for (BundleCamera& c : expected.cameras) {
      c.world_T_camera.translation = origin + scale * (c.world_T_camera.translation - origin);
    }
    for (BundlePoint& p : expected.points) p.inverse_depth /= scale;
    EXPECT_LT(largestTranslationError(problem, expected), 1e-6);
    EXPECT_LT(largestRotationError(problem, expected), 1e-6);
    EXPECT_LT(largestDepthError(problem, expected), 1e-6);
  }
}

// One of the cameras is not where it should be: it finds its place, and the others do not move.
TEST_P(BundleAdjustmentOfModel, OneOfManyCamerasThatHoldTheScaleDoesNotChangeIt) {
  Random random(22);
  BundleSceneOptions options;
  options.model = GetParam();
  options.fixed = 1;
  const BundleScene scene = makeBundleScene(random, options);
  for (const bool median : {false, true}) {
    BundleProblem problem = scene.truth;
    BundleCamera& wrong = problem.cameras[5];
    const Eigen::Vector3d origin = problem.cameras[0].world_T_camera.translation;
    wrong.world_T_camera.translation = origin + 0.9 * (wrong.world_T_camera.translation - origin);
    problem.scale_camera = 5;
    if (median) problem.scale_cameras = {1, 2, 3, 4, 5};
    ASSERT_TRUE(adjustBundle(scene.camera, problem, manyIterations()).usable);
    const double error = largestTranslationError(problem, scene.truth);
    if (median) {
      EXPECT_LT(error, 1e-6);
    } else {
      EXPECT_GT(error, 0.01);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, BundleAdjustmentOfModel,
                         testing::Values(CameraModel::pinhole_radial_tangential, CameraModel::kannala_brandt));

TEST(BundleAdjustment, EdgesOfEveryDirectionRecoverTheStructure) {
  Random random(3);
  BundleSceneOptions options;
  options.sigma_tangent = 1000;
  const BundleScene scene = makeBundleScene(random, options);
  BundleProblem problem = perturbedProblem(random, scene.truth, 0.02, 0.01);
  ASSERT_TRUE(adjustBundle(scene.camera, problem, manyIterations()).usable);
  EXPECT_LT(largestTranslationError(problem, scene.truth), 1e-5);
  EXPECT_LT(largestRotationError(problem, scene.truth), 1e-5);
}

TEST(BundleAdjustment, NoiseGivesTheErrorThatItShould) {
  Random random(4);
  double cost_ratio = 0, depth_nees = 0;
  int depths = 0;
  constexpr int runs = 10;
  for (int run = 0; run < runs; ++run) {
    BundleSceneOptions options;
    options.noise = 1;
    const BundleScene scene = makeBundleScene(random, options);
    BundleProblem problem = perturbedProblem(random, scene.truth, 0.05, 0.02);
    BundleOptions quadratic = manyIterations();
    quadratic.huber = 1e3;
    const BundleResult result = adjustBundle(scene.camera, problem, quadratic);
    ASSERT_TRUE(result.usable);
    // Half a degree of freedom each: residuals less unknowns.
    const double freedom = 2.0 * static_cast<double>(problem.observations.size()) - 4 * 6 - 150;
    cost_ratio += result.final_cost / (0.5 * freedom) / runs;
    EXPECT_LT(largestTranslationError(problem, scene.truth), 0.02);
    EXPECT_LT(largestRotationError(problem, scene.truth), 0.004);
    // Depths with exact poses: their deviation is the one given.
    BundleProblem held = scene.truth;
    for (BundleCamera& c : held.cameras) c.fixed = true;
    const BundleResult held_result = adjustBundle(scene.camera, held, quadratic);
    ASSERT_TRUE(held_result.usable);
    for (std::size_t i = 0; i < held.points.size(); ++i) {
      const double error =
          (held.points[i].inverse_depth - scene.truth.points[i].inverse_depth) / held_result.depth_sigmas[i];
      depth_nees += error * error;
      ++depths;
    }
  }
  EXPECT_NEAR(cost_ratio, 1, 0.05);
  EXPECT_NEAR(depth_nees / depths, 1, 0.15);
}

TEST(BundleAdjustment, OutliersAreSuppressed) {
  Random random(5);
  for (int run = 0; run < 10; ++run) {
    BundleSceneOptions options;
    options.noise = 1;
    options.sigma_normal = options.sigma_tangent = 0.3;
    BundleScene scene = makeBundleScene(random, options);
    std::vector<char> is_outlier;
    for (BundleObservation& o : scene.truth.observations) {
      const bool outlier = uniform(random, 0, 1) < 0.1;
      is_outlier.push_back(outlier);
      const double angle = uniform(random, -M_PI, M_PI);
      if (outlier) o.measurement.pixel += uniform(random, 10, 60) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    }
    BundleProblem problem = perturbedProblem(random, scene.truth, 0.02, 0.01);
    const BundleResult result = adjustBundle(scene.camera, problem, manyIterations());
    ASSERT_TRUE(result.usable);
    EXPECT_LT(largestTranslationError(problem, scene.truth), 0.02);
    EXPECT_LT(largestRotationError(problem, scene.truth), 0.004);
    int large = 0, large_outliers = 0, outliers = 0;
    for (std::size_t i = 0; i < is_outlier.size(); ++i) {
      outliers += is_outlier[i];
      large += result.errors[i] > 5;
      large_outliers += result.errors[i] > 5 && is_outlier[i];
    }
    EXPECT_GT(large_outliers, 0.9 * outliers);
    EXPECT_LT(large - large_outliers, 0.03 * static_cast<double>(is_outlier.size()));
  }
}

TEST(BundleAdjustment, FixedThingsStayToTheLastBit) {
  Random random(6);
  BundleSceneOptions options;
  options.noise = 1;
  const BundleScene scene = makeBundleScene(random, options);
  BundleProblem problem = perturbedProblem(random, scene.truth, 0.05, 0.02);
  problem.scale_camera = 5;  // and are not scaled either
  for (std::size_t i = 0; i < problem.points.size(); i += 3) problem.points[i].fixed = true;
  const BundleProblem before = problem;
  ASSERT_TRUE(adjustBundle(scene.camera, problem, {}).usable);
  for (std::size_t i = 0; i < problem.cameras.size(); ++i) {
    EXPECT_EQ(sameBytes(problem.cameras[i].world_T_camera, before.cameras[i].world_T_camera), before.cameras[i].fixed);
  }
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    if (!before.points[i].fixed) continue;
    EXPECT_EQ(problem.points[i].inverse_depth, before.points[i].inverse_depth);
  }
}

TEST(BundleAdjustment, OnlyCamerasOrOnlyPointsFree) {
  Random random(7);
  const BundleScene scene = makeBundleScene(random, {});
  BundleProblem truth = scene.truth;
  for (BundlePoint& p : truth.points) p.fixed = true;
  BundleProblem problem = perturbedProblem(random, truth, 0.1, 0.05);
  ASSERT_TRUE(adjustBundle(scene.camera, problem, manyIterations()).usable);
  EXPECT_LT(largestTranslationError(problem, truth), 1e-6);

  truth = scene.truth;
  for (BundleCamera& c : truth.cameras) c.fixed = true;
  problem = perturbedProblem(random, truth, 0.1, 0.05);
  ASSERT_TRUE(adjustBundle(scene.camera, problem, manyIterations()).usable);
  EXPECT_LT(largestDepthError(problem, truth), 1e-6);
}

TEST(BundleAdjustment, LargeProblemsTakeTheSparseWayToTheSameEnd) {
  Random random(8);
  BundleSceneOptions options;
  options.cameras = 40;
  options.points = 200;
  const BundleScene scene = makeBundleScene(random, options);
  BundleProblem problem = perturbedProblem(random, scene.truth, 0.02, 0.02);
  ASSERT_TRUE(adjustBundle(scene.camera, problem, manyIterations()).usable);
  EXPECT_LT(largestTranslationError(problem, scene.truth), 1e-6);
  EXPECT_LT(largestDepthError(problem, scene.truth), 1e-6);
}

class BundleAdjustmentBesideCeres : public testing::TestWithParam<int> {};

TEST_P(BundleAdjustmentBesideCeres, EndsAtTheSameMinimum) {
  Random random(16);
  for (int run = 0; run < 6; ++run) {
    BundleSceneOptions options;
    options.cameras = GetParam();
    options.noise = 1;
    if (run % 3 == 1) options.sigma_tangent = 1000;
    if (run % 2 == 1) options.model = CameraModel::kannala_brandt;
    BundleScene scene = makeBundleScene(random, options);
    for (BundleObservation& o : scene.truth.observations) {
      if (uniform(random, 0, 1) < 0.05) o.measurement.pixel += uniform(random, 5, 20) * Eigen::Vector2d::UnitY();
    }
    for (std::size_t i = 0; i < scene.truth.points.size(); i += 5) scene.truth.points[i].fixed = i % 2 == 0;
    for (std::size_t i = 1; i < scene.truth.points.size(); i += 5) {
      scene.truth.points[i].prior_sigma = 0.1;
      scene.truth.points[i].prior_inverse_depth = scene.truth.points[i].inverse_depth;
    }
    BundleProblem ours = perturbedProblem(random, scene.truth, 0.02, 0.01), reference = ours;
    BundleOptions many;
    many.iterations = 100;
    const BundleResult result = adjustBundle(scene.camera, ours, many);
    ASSERT_TRUE(result.usable);
    ASSERT_GT(adjustBundleByCeres(scene.camera, reference, many), 0);
    // Both stop where a step gains less than 1e-6 of the cost.
    BundleProblem copy = reference;
    const double reference_cost = adjustBundle(scene.camera, copy, {0, many.huber}).final_cost;
    EXPECT_NEAR(result.final_cost, reference_cost, 1e-5 * reference_cost);
    EXPECT_LT(largestTranslationError(ours, reference), 2e-4);
    EXPECT_LT(largestRotationError(ours, reference), 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Cameras, BundleAdjustmentBesideCeres, testing::Values(3, 6, 40));

TEST(BundleAdjustment, PriorHoldsWhatParallaxDoesNot) {
  // Two cameras at one place tell nothing of depth.
  Random random(9);
  BundleSceneOptions options;
  options.cameras = 2;
  BundleScene scene = makeBundleScene(random, options);
  BundleProblem problem = scene.truth;
  problem.cameras[1].world_T_camera.translation = problem.cameras[0].world_T_camera.translation;
  for (BundlePoint& p : problem.points) {
    p.prior_inverse_depth = 0.4;
    p.prior_sigma = 0.1;
  }
  const BundleResult result = adjustBundle(scene.camera, problem, manyIterations());
  ASSERT_TRUE(result.usable);
  for (std::size_t i = 0; i < problem.points.size(); ++i) {
    EXPECT_NEAR(problem.points[i].inverse_depth, 0.4, 1e-3);
    EXPECT_NEAR(result.depth_sigmas[i], 0.1, 1e-9);
  }
}

TEST(BundleAdjustment, FarPointsStayBeforeTheCamera) {
  Random random(10);
  BundleSceneOptions options;
  options.noise = 1;
  options.sigma_normal = options.sigma_tangent = 2;
  BundleScene scene = makeBundleScene(random, options);
  BundleProblem problem = scene.truth;
  // Points practically at infinity: noise alone would put half of them beyond it.
  for (BundlePoint& p : problem.points) p.inverse_depth = 1e-4;
  for (BundleObservation& o : problem.observations) {
    const BundlePoint& p = problem.points[static_cast<std::size_t>(o.point)];
    const Pose& host = problem.cameras[static_cast<std::size_t>(p.host)].world_T_camera;
    const Pose& target = problem.cameras[static_cast<std::size_t>(o.camera)].world_T_camera;
    const Eigen::Vector3d seen = target.inverse() * (host * (p.host_bearing / p.inverse_depth));
    o.measurement.pixel = project(scene.camera, seen) + Eigen::Vector2d(gaussian(random, 2), gaussian(random, 2));
  }
  const BundleProblem truth = problem;
  problem = perturbedProblem(random, truth, 0, 0.01);
  const BundleResult result = adjustBundle(scene.camera, problem, manyIterations());
  ASSERT_TRUE(result.usable);
  for (const BundlePoint& p : problem.points) EXPECT_GT(p.inverse_depth, 0);
  EXPECT_LT(largestRotationError(problem, truth), 0.005);
}

TEST(BundleAdjustment, SameInputSameBytes) {
  for (const int cameras : {6, 40}) {
    Random random(11);
    BundleSceneOptions options;
    options.cameras = cameras;
    options.fixed = 1;
    options.noise = 1;
    const BundleScene scene = makeBundleScene(random, options);
    BundleProblem first = perturbedProblem(random, scene.truth, 0.05, 0.02);
    first.scale_camera = 1;
    BundleProblem second = first;
    // Something else on the heap must not matter.
    const BundleResult first_result = adjustBundle(scene.camera, first, {});
    const std::vector<double> elsewhere(100003, 1.0);
    const BundleResult second_result = adjustBundle(scene.camera, second, {});
    ASSERT_TRUE(first_result.usable);
    EXPECT_TRUE(sameBytes(first, second)) << cameras;
    EXPECT_EQ(first_result.errors, second_result.errors);
    EXPECT_EQ(first_result.depth_sigmas, second_result.depth_sigmas);
    EXPECT_EQ(first_result.final_cost, second_result.final_cost);
  }
}

}  // namespace
}  // namespace edgeslam::test
