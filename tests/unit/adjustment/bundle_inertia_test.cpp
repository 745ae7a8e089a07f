// What an inertial unit and wheels say in a bundle adjustment: derivatives, the scale that it holds, and values of no
// use.
#include "adjustment/bundle_inertia.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "synthetic_bundle.h"

namespace edgeslam::test {
namespace {

Eigen::Matrix3d someWhitening(Random& random, double information) {
  Eigen::Matrix3d whitening = Eigen::Matrix3d::Zero();
  for (int row = 0; row < 3; ++row) {
    whitening(row, row) = information * uniform(random, 0.5, 1.5);
    for (int column = 0; column < row; ++column) whitening(row, column) = information * uniform(random, -0.3, 0.3);
  }
  return whitening;
}

// What a unit would say of all cameras of a problem, in order.
void addInertia(Random& random, double turn_information, double speed_information, BundleProblem& problem) {
  problem.inertia = {2.5, {1, -9.5, 2}, {0.1, -0.2, 0.05}};
  const auto pose = [&](std::size_t c) { return problem.cameras[c].world_T_camera; };
  const auto place = [&](std::size_t c) -> Eigen::Vector3d {
    return problem.inertia.metres_a_unit * pose(c).translation + pose(c).rotation * problem.inertia.camera_t_imu;
  };
  for (std::size_t c = 1; c < problem.cameras.size(); ++c) {
    const int now = static_cast<int>(c);
    problem.turns.push_back(
        {now - 1, now, pose(c - 1).rotation.conjugate() * pose(c).rotation, someWhitening(random, turn_information)});
    problem.ways.push_back({now - 1, now,
                            problem.inertia.metres_a_unit *
                                (pose(c - 1).rotation.conjugate() * (pose(c).translation - pose(c - 1).translation)),
                            someWhitening(random, speed_information), inertial_huber_times,
                            problem.inertia.metres_a_unit});
    if (c < 2) continue;
    BundleSpeedChange change;
    change.cameras = {now - 2, now - 1, now};
    change.seconds = {uniform(random, 0.2, 0.6), uniform(random, 0.2, 0.6)};
    const double t1 = change.seconds[0], t2 = change.seconds[1];
    const Eigen::Vector3d difference =
        (place(c) - place(c - 1)) / t2 - (place(c - 1) - place(c - 2)) / t1 - 0.5 * (t1 + t2) * problem.inertia.gravity;
    change.of_second = uniformVector(random, 1);
    change.of_first = pose(c - 2).rotation.conjugate() * (difference - pose(c - 1).rotation * change.of_second);
    change.whitening = someWhitening(random, speed_information);
    problem.speed_changes.push_back(change);
  }
}

BundleScene sceneWithInertia(Random& random, int cameras, int fixed, double turn_information = 300) {
  BundleSceneOptions options;
  options.cameras = cameras;
  options.fixed = fixed;
  BundleScene scene = makeBundleScene(random, options);
  addInertia(random, turn_information, 50, scene.truth);
  return scene;
}

TEST(BundleInertia, CostsNothingAtTheTruth) {
  Random random(1);
  const BundleScene scene = sceneWithInertia(random, 6, 1);
  EXPECT_EQ(scene.truth.turns.size(), 5U);
  EXPECT_EQ(scene.truth.speed_changes.size(), 4U);
  EXPECT_LT(inertialCost(scene.truth, test_huber), 1e-16);
}

// With all blocks of the reduced system, and with those that are asked for.
class BundleInertiaOf : public testing::TestWithParam<int> {};

TEST_P(BundleInertiaOf, DerivativesAreTheNumericOnes) {
  Random random(2);
  const BundleScene scene = sceneWithInertia(random, 6, 1);
  BundleProblem problem = perturbedProblem(random, scene.truth, 0.005, 0.003);
  BundleStructure structure;
  structureBundle(scene.camera, problem, GetParam(), structure);
  BundleState state;
  for (const BundleCamera& c : problem.cameras) {
    state.rotations.push_back(c.world_T_camera.rotation);
    state.frames.push_back(cameraFrame(c.world_T_camera));
  }
  state.inertia = problem.inertia;
  ASSERT_GT(inertialCost(problem, structure, state, 1e3), 1);
  EXPECT_NEAR(inertialCost(problem, structure, state, test_huber), inertialCost(problem, test_huber), 1e-9);

  const auto unknowns = static_cast<Eigen::Index>(structure.camera_of_unknown.size());
  ASSERT_EQ(unknowns, 5);
  const auto linearized = [&](double with_huber) {
    BundleLinearization made;
    made.origin = {0.3, -0.2, 0.5};
    made.blocks.assign(structure.places.size(), Matrix6d::Zero());
    made.diagonal.assign(static_cast<std::size_t>(unknowns), Matrix6d::Zero());
    made.camera_gradient.setZero(6 * unknowns);
    linearizeInertia(problem, structure, state, with_huber, made);
    return made;
  };
  const auto costOf = [&](const Eigen::VectorXd& twists, double with_huber) {
    BundleState moved = state;
    for (Eigen::Index k = 0; k < unknowns; ++k) {
      const auto c = static_cast<std::size_t>(structure.camera_of_unknown[static_cast<std::size_t>(k)]);
      const Vector6d twist = twists.segment<6>(6 * k);
      const Eigen::Vector3d lever = state.frames[c].centre - Eigen::Vector3d(0.3, -0.2, 0.5);
      moved.rotations[c] = rotationExp(twist.tail<3>()) * state.rotations[c];
      moved.frames[c].centre += twist.head<3>() + twist.tail<3>().cross(lever);
    }
    return inertialCost(problem, structure, moved, with_huber);
  };
  for (const double with_huber : {test_huber, 1e3}) {
    const BundleLinearization made = linearized(with_huber);
    for (Eigen::Index k = 0; k < 6 * unknowns; ++k) {
      constexpr double step = 1e-6;
      const Eigen::VectorXd change = step * Eigen::VectorXd::Unit(6 * unknowns, k);
      const double numeric = (costOf(change, with_huber) - costOf(-change, with_huber)) / (2 * step);
      EXPECT_NEAR(made.camera_gradient(k), numeric, 1e-4 * std::max(1.0, made.camera_gradient.norm())) << k;
    }
  }
  // Where all is explained, the curvature is that of the normal equations.
  problem = scene.truth;
  for (std::size_t c = 0; c < problem.cameras.size(); ++c) {
    state.rotations[c] = problem.cameras[c].world_T_camera.rotation;
    state.frames[c] = cameraFrame(problem.cameras[c].world_T_camera);
  }
  const BundleLinearization made = linearized(1e3);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(6 * unknowns, 6 * unknowns);
  for (std::size_t b = 0; b < structure.places.size(); ++b) {
    const Eigen::Index row = 6 * structure.places[b].row, column = 6 * structure.places[b].column;
    information.block<6, 6>(row, column) += made.blocks[b];
    if (row != column) information.block<6, 6>(column, row) += made.blocks[b].transpose();
  }
  for (Eigen::Index k = 0; k < unknowns; ++k) {
    information.block<6, 6>(6 * k, 6 * k) += made.diagonal[static_cast<std::size_t>(k)];
  }
  for (int run = 0; run < 20; ++run) {
    Eigen::VectorXd change(6 * unknowns);
    for (Eigen::Index k = 0; k < change.size(); ++k) change(k) = uniform(random, -1e-5, 1e-5);
    const double expected = 0.5 * change.dot(information * change);
    EXPECT_NEAR(costOf(change, 1e3), expected, 0.01 * expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Blocks, BundleInertiaOf, testing::Values(30, 0));

// The same inertia with biases in what was measured, which the problem is to find.
void addBiases(Random& random, const Vector6d& biases, BundleProblem& problem) {
  problem.inertia.is_free = true;
  problem.inertia.rate_bias_sigma = 1;
  problem.inertia.force_bias_sigma = 10;
  const auto some = [&] { return Eigen::Matrix3d(uniform(random, 0.2, 0.6) * Eigen::Matrix3d::Identity()); };
  for (BundleTurn& turn : problem.turns) {
    turn.by_rate_bias = -some();
    turn.first_R_second = turn.first_R_second * rotationExp(turn.by_rate_bias * biases.head<3>()).conjugate();
  }
  for (BundleSpeedChange& change : problem.speed_changes) {
    change.first_by_bias << 0.1 * some(), -some();
    change.second_by_bias << 0.1 * some(), -some();
    change.of_first -= change.first_by_bias * biases;
    change.of_second -= change.second_by_bias * biases;
  }
}

const Vector6d some_biases = (Vector6d() << 0.01, -0.02, 0.015, 0.2, -0.1, 0.15).finished();

TEST(BundleInertia, DerivativesByScaleGravityAndBiasesAreTheNumericOnes) {
  Random random(6);
  BundleProblem truth = sceneWithInertia(random, 6, 1).truth;
  const Camera camera = sceneWithInertia(random, 6, 1).camera;
  addBiases(random, some_biases, truth);
  truth.inertia.rate_bias_sigma = truth.inertia.force_bias_sigma = 0;
  truth.inertia.bias_change = some_biases;
  truth.inertia.told_metres_a_unit = truth.inertia.metres_a_unit;
  truth.inertia.told_scale_sigma = 0.02;
  BundleStructure structure;
  structureBundle(camera, truth, 30, structure);
  BundleState state;
  for (const BundleCamera& c : truth.cameras) {
    state.rotations.push_back(c.world_T_camera.rotation);
    state.frames.push_back(cameraFrame(c.world_T_camera));
  }
  const auto unknowns = static_cast<Eigen::Index>(structure.camera_of_unknown.size());
  const auto linearizedAt = [&](const InertiaVector& change) {
    state.inertia = movedInertia(truth.inertia, change);
    BundleLinearization made;
    made.blocks.assign(structure.places.size(), Matrix6d::Zero());
    made.diagonal.assign(static_cast<std::size_t>(unknowns), Matrix6d::Zero());
    made.camera_gradient.setZero(6 * unknowns);
    linearizeInertia(truth, structure, state, 1e3, made);
    return made;
  };
  const BundleLinearization at_truth = linearizedAt(InertiaVector::Zero());
  EXPECT_LT(at_truth.cost, 1e-12) << "all is explained";
  constexpr double step = 1e-6;
  for (int k = 0; k < 9; ++k) {
    const BundleLinearization more = linearizedAt(step * InertiaVector::Unit(k));
    const BundleLinearization less = linearizedAt(-step * InertiaVector::Unit(k));
    const Eigen::VectorXd border = (more.camera_gradient - less.camera_gradient) / (2 * step);
    EXPECT_LT((border - at_truth.inertia_border.col(k)).norm(), 1e-4 * (1 + border.norm())) << k;
    const InertiaVector block = (more.inertia_gradient - less.inertia_gradient) / (2 * step);
    EXPECT_LT((block - at_truth.inertia_block.col(k)).norm(), 1e-4 * (1 + block.norm())) << k;
    // Away from there, the gradient is that of the cost.
    const InertiaVector away = InertiaVector::Constant(0.01);
    const double numeric = (linearizedAt(away + step * InertiaVector::Unit(k)).cost -
                            linearizedAt(away - step * InertiaVector::Unit(k)).cost) /
                           (2 * step);
    if (k >= 1 && k < 3) continue;  // tilts are those of gravity as it is then
    const double gradient = linearizedAt(away).inertia_gradient(k);
    EXPECT_NEAR(gradient, numeric, 1e-3 * (1 + std::abs(gradient))) << k;
  }
}

TEST_P(BundleInertiaOf, ScaleGravityAndBiasesAreFoundWithTheMap) {
  Random random(7);
  BundleSceneOptions options;
  options.cameras = GetParam() > 0 ? 12 : 34;  // with all blocks, and with those that are asked for
  options.fixed = 1;
  BundleScene scene = makeBundleScene(random, options);
  addInertia(random, 300, 50, scene.truth);
  scene.truth.ways.clear();
  addBiases(random, some_biases, scene.truth);
  BundleProblem problem = perturbedProblem(random, scene.truth, 0.005, 0.003);
  problem.scale_camera = options.cameras - 1;
  problem.inertia.metres_a_unit *= 1.2;
  problem.inertia.gravity = rotationExp({0.1, -0.05, 0.02}) * problem.inertia.gravity;
  const BundleResult result = adjustBundle(scene.camera, problem, manyIterations());
  ASSERT_TRUE(result.usable);
  EXPECT_LT(result.final_cost, 1e-3);
  const auto length = [&](const BundleProblem& of) {
    return (of.cameras.back().world_T_camera.translation - of.cameras.front().world_T_camera.translation).norm();
  };
  EXPECT_NEAR(problem.inertia.metres_a_unit * length(problem), scene.truth.inertia.metres_a_unit * length(scene.truth),
              1e-3);
  EXPECT_LT((problem.inertia.gravity - scene.truth.inertia.gravity).norm(), 1e-2);
  EXPECT_LT((problem.inertia.bias_change.head<3>() - some_biases.head<3>()).norm(), 1e-3);
  EXPECT_LT((problem.inertia.bias_change.tail<3>() - some_biases.tail<3>()).norm(), 1e-2);
  EXPECT_GT(result.inertia_covariance.diagonal().minCoeff(), 0);
  EXPECT_LT(std::sqrt(result.inertia_covariance(0, 0)), 0.1);
}

// Wheels hold the unit of the map by their own metre, and what they tell of the scale counts as well as it is known.
TEST(BundleInertia, AScaleThatIsToldCountsAsWellAsItIsKnown) {
  const auto scaleWith = [](double told_share, double sigma) {
    Random random(9);
    BundleProblem problem = sceneWithInertia(random, 8, 1).truth;
    const double true_scale = problem.inertia.metres_a_unit;
    addBiases(random, Vector6d::Zero(), problem);
    problem.inertia.told_metres_a_unit = told_share * true_scale;
    problem.inertia.told_scale_sigma = sigma;
    for (BundleWay& way : problem.ways) {  // wheels that are larger than they are taken to be
      way.way *= 1.05;
      way.metres_a_unit *= 1.05;
    }
    Random again(9);
    const BundleResult result = adjustBundle(sceneWithInertia(again, 8, 1).camera, problem, manyIterations());
    EXPECT_TRUE(result.usable);
    return problem.inertia.metres_a_unit / true_scale;
  };
  EXPECT_NEAR(scaleWith(1.05, 0), 1, 1e-3) << "of inertia alone";
  EXPECT_NEAR(scaleWith(1.05, 1e-5), 1.05, 2e-3);
  const double both = scaleWith(1.05, 0.02);
  EXPECT_GT(both, 1);
  EXPECT_LT(both, 1.05);
}

TEST(BundleInertia, TellsTheScaleThatPointsCannot) {
  Random random(3);
  const BundleScene scene = sceneWithInertia(random, 6, 1);
  // A map that is a third too large fits all that is seen.
  BundleProblem problem = scene.truth;
  const Eigen::Vector3d origin = problem.cameras[0].world_T_camera.translation;
  for (BundleCamera& c : problem.cameras) {
    Eigen::Vector3d& centre = c.world_T_camera.translation;
    centre = origin + 1.3 * (centre - origin);
  }
  for (BundlePoint& p : problem.points) p.inverse_depth /= 1.3;
  BundleProblem seen_only = problem;
  seen_only.turns.clear();
  seen_only.speed_changes.clear();
  seen_only.ways.clear();
  ASSERT_TRUE(adjustBundle(scene.camera, seen_only, manyIterations()).usable);
  EXPECT_GT(largestTranslationError(seen_only, scene.truth), 0.2);
  ASSERT_TRUE(adjustBundle(scene.camera, problem, manyIterations()).usable);
  EXPECT_LT(largestTranslationError(problem, scene.truth), 1e-4);
  EXPECT_LT(largestDepthError(problem, scene.truth), 1e-4);
}

TEST(BundleInertia, HoldsTurnsThatLittleIsSeenOf) {
  Random random(4);
  BundleScene scene = sceneWithInertia(random, 6, 1, 5000);
  BundleProblem& truth = scene.truth;
  truth.speed_changes.clear();
  truth.ways.clear();
  truth.scale_camera = 5;
  for (BundleObservation& o : truth.observations) {
    o.measurement.sigma_normal = o.measurement.sigma_tangent = 5;
    o.measurement.pixel += 5 * uniformVector(random, 1).head<2>();
  }
  BundleProblem with = truth, without = truth;
  without.turns.clear();
  ASSERT_TRUE(adjustBundle(scene.camera, with, manyIterations()).usable);
  ASSERT_TRUE(adjustBundle(scene.camera, without, manyIterations()).usable);
  EXPECT_LT(largestRotationError(with, truth), 0.5 * largestRotationError(without, truth));
}

TEST(BundleInertia, ValuesOfNoUseTakeNoPart) {
  Random random(5);
  const BundleScene scene = sceneWithInertia(random, 6, 1);
  BundleProblem plain = scene.truth;
  plain.turns.clear();
  plain.speed_changes.clear();
  plain.ways.clear();
  BundleProblem useless = plain;
  useless.turns.assign(1, {1, 1, Eigen::Quaterniond::Identity(), Eigen::Matrix3d::Identity()});
  useless.turns.push_back(
      {1, 2, Eigen::Quaterniond::Identity(), std::numeric_limits<double>::quiet_NaN() * Eigen::Matrix3d::Identity()});
  BundleSpeedChange change = scene.truth.speed_changes.front();
  change.seconds[1] = 0;
  useless.speed_changes.push_back(change);
  change = scene.truth.speed_changes.front();
  change.of_first.x() = std::numeric_limits<double>::infinity();
  useless.speed_changes.push_back(change);
  useless.ways.assign(1, {2, 2, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()});
  useless.ways.push_back(
      {1, 2, Eigen::Vector3d(0, std::numeric_limits<double>::quiet_NaN(), 0), Eigen::Matrix3d::Identity()});
  plain.scale_camera = useless.scale_camera = -1;
  ASSERT_TRUE(adjustBundle(scene.camera, plain, manyIterations()).usable);
  ASSERT_TRUE(adjustBundle(scene.camera, useless, manyIterations()).usable);
  EXPECT_TRUE(sameBytes(plain, useless));

  BundleProblem out_of_range = scene.truth;
  out_of_range.speed_changes.front().cameras[2] = 6;
  EXPECT_FALSE(adjustBundle(scene.camera, out_of_range, manyIterations()).usable);
  out_of_range = scene.truth;
  out_of_range.turns.front().first = -1;
  EXPECT_FALSE(adjustBundle(scene.camera, out_of_range, manyIterations()).usable);
  out_of_range = scene.truth;
  out_of_range.ways.front().second = 6;
  EXPECT_FALSE(adjustBundle(scene.camera, out_of_range, manyIterations()).usable);
}

// Before a blank wall.
TEST(BundleInertia, WheelsPlaceACameraThatSeesNothing) {
  Random random(6);
  BundleScene scene = sceneWithInertia(random, 6, 1);
  BundleProblem& truth = scene.truth;
  truth.speed_changes.clear();
  const auto isOfLast = [&](const BundleObservation& o) {
    return o.camera == 5 || truth.points[static_cast<std::size_t>(o.point)].host == 5;
  };
  truth.observations.erase(std::remove_if(truth.observations.begin(), truth.observations.end(), isOfLast),
                           truth.observations.end());
  BundleProblem problem = perturbedProblem(random, truth, 0.005, 0.003);
  ASSERT_TRUE(adjustBundle(scene.camera, problem, manyIterations()).usable);
  EXPECT_LT(largestTranslationError(problem, truth), 1e-4);
  EXPECT_LT(largestRotationError(problem, truth), 1e-4);
}

}  // namespace
}  // namespace edgeslam::test
