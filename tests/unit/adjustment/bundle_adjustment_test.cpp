#include "adjustment/bundle_adjustment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "adjustment/reprojection.h"
#include "synthetic_scene.h"

namespace edgeslam::test {
namespace {

struct Scene {
  Camera camera;
  BundleProblem truth;  // observations without noise
};

struct SceneOptions {
  int cameras = 6;
  int fixed = 2;
  int points = 150;
  double sigma_normal = 0.5;
  double sigma_tangent = 0.5;
  double noise = 0;
  CameraModel model = CameraModel::pinhole_radial_tangential;
};

// Cameras on a line of 1 unit, points at 1.5 to 6 units, each hosted by one camera and seen by all others that can, at
// least by one.
Scene makeScene(Random& random, const SceneOptions& options) {
  Scene scene;
  scene.camera = testCamera(options.model);
  BundleProblem& problem = scene.truth;
  for (int i = 0; i < options.cameras; ++i) {
    BundleCamera camera;
    camera.world_T_camera = randomPose(random, 0.1, 0.1);
    camera.world_T_camera.translation.x() += static_cast<double>(i) / (options.cameras - 1);
    camera.fixed = i < options.fixed;
    problem.cameras.push_back(camera);
  }
  while (static_cast<int>(problem.points.size()) < options.points) {
    const int index = static_cast<int>(problem.points.size());
    const std::size_t observations_before = problem.observations.size();
    BundlePoint point;
    point.host = index % options.cameras;
    point.host_bearing = bearing(scene.camera, randomPixel(random, scene.camera));
    point.inverse_depth = 1 / uniform(random, 1.5, 6);
    const Eigen::Vector3d world = problem.cameras[static_cast<std::size_t>(point.host)].world_T_camera *
                                  (point.host_bearing / point.inverse_depth);
    for (int c = 0; c < options.cameras; ++c) {
      if (c == point.host) continue;
      const Eigen::Vector3d seen = problem.cameras[static_cast<std::size_t>(c)].world_T_camera.inverse() * world;
      if (!inFront(scene.camera, seen)) continue;
      const Eigen::Vector2d pixel = project(scene.camera, seen);
      if (!insideImage(scene.camera, pixel)) continue;
      BundleObservation o;
      o.camera = c;
      o.point = index;
      o.measurement = measure(random, pixel, uniform(random, -M_PI, M_PI), options.sigma_normal, options.sigma_tangent,
                              options.noise);
      problem.observations.push_back(o);
    }
    if (problem.observations.size() > observations_before) problem.points.push_back(point);
  }
  return scene;
}

// The truth with its free cameras moved and its free points' depths off by up to 20 %.
BundleProblem perturbedProblem(Random& random, const BundleProblem& truth, double translation, double rotation) {
  BundleProblem problem = truth;
  for (BundleCamera& c : problem.cameras) {
    if (!c.fixed) c.world_T_camera = perturbed(random, c.world_T_camera, translation, rotation);
  }
  for (BundlePoint& p : problem.points) {
    if (!p.fixed) p.inverse_depth *= uniform(random, 0.8, 1.25);
  }
  return problem;
}

double largestTranslationError(const BundleProblem& a, const BundleProblem& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    largest =
        std::max(largest, (a.cameras[i].world_T_camera.translation - b.cameras[i].world_T_camera.translation).norm());
  }
  return largest;
}

double largestRotationError(const BundleProblem& a, const BundleProblem& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    largest =
        std::max(largest, rotationAngle(a.cameras[i].world_T_camera.rotation, b.cameras[i].world_T_camera.rotation));
  }
  return largest;
}

double largestDepthError(const BundleProblem& a, const BundleProblem& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    largest = std::max(largest, std::abs(a.points[i].inverse_depth - b.points[i].inverse_depth));
  }
  return largest;
}

bool sameBytes(const Pose& a, const Pose& b) {
  return a.rotation.coeffs() == b.rotation.coeffs() && a.translation == b.translation;
}

bool sameBytes(const BundleProblem& a, const BundleProblem& b) {
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    if (!sameBytes(a.cameras[i].world_T_camera, b.cameras[i].world_T_camera)) return false;
  }
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    if (a.points[i].inverse_depth != b.points[i].inverse_depth) return false;
  }
  return true;
}

BundleOptions manyIterations() {
  BundleOptions options;
  options.iterations = 50;
  return options;
}

class BundleAdjustmentOfModel : public testing::TestWithParam<CameraModel> {};

TEST_P(BundleAdjustmentOfModel, RecoversExactStructure) {
  Random random(1);
  for (int run = 0; run < 10; ++run) {
    SceneOptions options;
    options.model = GetParam();
    const Scene scene = makeScene(random, options);
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
    SceneOptions options;
    options.model = GetParam();
    options.fixed = 1;
    const Scene scene = makeScene(random, options);
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

INSTANTIATE_TEST_SUITE_P(Models, BundleAdjustmentOfModel,
                         testing::Values(CameraModel::pinhole_radial_tangential, CameraModel::kannala_brandt));

TEST(BundleAdjustment, EdgesOfEveryDirectionRecoverTheStructure) {
  Random random(3);
  SceneOptions options;
  options.sigma_tangent = 1000;
  const Scene scene = makeScene(random, options);
  BundleProblem problem = perturbedProblem(random, scene.truth, 0.02, 0.01);
  ASSERT_TRUE(adjustBundle(scene.camera, problem, manyIterations()).usable);
  EXPECT_LT(largestTranslationError(problem, scene.truth), 1e-5);
  EXPECT_LT(largestRotationError(problem, scene.truth), 1e-5);
}

TEST(BundleAdjustment, NoiseGivesTheErrorThatItShould) {
  Random random(4);
  double cost_ratio = 0, depth_nees = 0;
  int depths = 0;
  constexpr int kRuns = 10;
  for (int run = 0; run < kRuns; ++run) {
    SceneOptions options;
    options.noise = 1;
    const Scene scene = makeScene(random, options);
    BundleProblem problem = perturbedProblem(random, scene.truth, 0.05, 0.02);
    BundleOptions quadratic = manyIterations();
    quadratic.huber = 1e3;
    const BundleResult result = adjustBundle(scene.camera, problem, quadratic);
    ASSERT_TRUE(result.usable);
    // Half a degree of freedom each: residuals less unknowns.
    const double freedom = 2.0 * static_cast<double>(problem.observations.size()) - 4 * 6 - 150;
    cost_ratio += result.final_cost / (0.5 * freedom) / kRuns;
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
    SceneOptions options;
    options.noise = 1;
    options.sigma_normal = options.sigma_tangent = 0.3;
    Scene scene = makeScene(random, options);
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
  SceneOptions options;
  options.noise = 1;
  const Scene scene = makeScene(random, options);
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
  const Scene scene = makeScene(random, {});
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
  SceneOptions options;
  options.cameras = 40;
  options.points = 200;
  const Scene scene = makeScene(random, options);
  BundleProblem problem = perturbedProblem(random, scene.truth, 0.02, 0.02);
  ASSERT_TRUE(adjustBundle(scene.camera, problem, manyIterations()).usable);
  EXPECT_LT(largestTranslationError(problem, scene.truth), 1e-6);
  EXPECT_LT(largestDepthError(problem, scene.truth), 1e-6);
}

TEST(BundleAdjustment, PriorHoldsWhatParallaxDoesNot) {
  // Two cameras at one place tell nothing of depth.
  Random random(9);
  SceneOptions options;
  options.cameras = 2;
  Scene scene = makeScene(random, options);
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
  SceneOptions options;
  options.noise = 1;
  options.sigma_normal = options.sigma_tangent = 2;
  Scene scene = makeScene(random, options);
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
    SceneOptions options;
    options.cameras = cameras;
    options.fixed = 1;
    options.noise = 1;
    const Scene scene = makeScene(random, options);
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

TEST(BundleAdjustment, NothingToAdjustIsNotUsable) {
  Random random(12);
  BundleProblem empty;
  EXPECT_FALSE(adjustBundle(testCamera(CameraModel::kannala_brandt), empty, {}).usable);

  Scene scene = makeScene(random, {});
  for (BundleCamera& c : scene.truth.cameras) c.fixed = true;
  for (BundlePoint& p : scene.truth.points) p.fixed = true;
  const BundleResult result = adjustBundle(scene.camera, scene.truth, {});
  EXPECT_FALSE(result.usable);
  ASSERT_EQ(result.errors.size(), scene.truth.observations.size());
  for (const double error : result.errors) EXPECT_LT(error, 1e-6);
}

TEST(BundleAdjustment, IndicesOutOfRangeLeaveTheProblem) {
  Random random(13);
  const Scene scene = makeScene(random, {});
  const BundleProblem good = perturbedProblem(random, scene.truth, 0.05, 0.02);
  for (const int bad : {-1, 1000000}) {
    for (int what = 0; what < 4; ++what) {
      BundleProblem problem = good;
      if (what == 0) problem.observations[3].camera = bad;
      if (what == 1) problem.observations[3].point = bad;
      if (what == 2) problem.points[3].host = bad;
      if (what == 3) problem.scale_camera = 1000000;
      const BundleResult result = adjustBundle(scene.camera, problem, {});
      EXPECT_FALSE(result.usable);
      EXPECT_TRUE(sameBytes(problem, good));
      EXPECT_EQ(result.errors.size(), problem.observations.size());
      EXPECT_EQ(result.depth_sigmas.size(), problem.points.size());
    }
  }
}

TEST(BundleAdjustment, ValuesThatAreNoNumbersTakeNoPart) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Random random(14);
  const Scene scene = makeScene(random, {});
  BundleProblem problem = perturbedProblem(random, scene.truth, 0.05, 0.02);
  problem.observations[0].measurement.pixel.x() = kNan;
  problem.observations[1].measurement.pixel.y() = kInfinity;
  problem.observations[2].measurement.sigma_normal = 0;
  problem.observations[3].measurement.normal.setConstant(kNan);
  problem.points[20].inverse_depth = kNan;
  problem.points[21].inverse_depth = -1;
  problem.points[22].host_bearing.x() = kNan;
  problem.points[23].prior_sigma = kNan;
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
  lost.cameras[4].world_T_camera.translation.x() = kNan;
  const double depth = lost.points[0].inverse_depth;
  EXPECT_FALSE(adjustBundle(scene.camera, lost, {}).usable);
  EXPECT_EQ(lost.points[0].inverse_depth, depth);
}

TEST(BundleAdjustment, PointsBehindTheCameraNeitherPullNorBlock) {
  Random random(15);
  const Scene scene = makeScene(random, {});
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
