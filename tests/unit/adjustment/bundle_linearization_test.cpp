// P19: the reduced normal equations are those of the whole problem.
#include "adjustment/bundle_linearization.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "adjustment/reduced_solver.h"
#include "synthetic_bundle.h"

namespace edgeslam::test {
namespace {

constexpr double huber = 2;

struct Linearized {
  BundleScene scene;
  BundleStructure structure;
  BundleState state;
  BundleLinearization linearization;
};

// Fixed and free cameras and points, priors, and an observation given twice.
Linearized linearized(const BundleSceneOptions& options, double damping, std::uint64_t seed, int most_dense = 30,
                      bool rolling = false) {
  Random random(seed);
  Linearized made;
  BundleScene& scene = made.scene = makeBundleScene(random, options);
  scene.truth = perturbedProblem(random, scene.truth, 0.02, 0.01);
  BundleProblem& problem = scene.truth;
  for (std::size_t i = 0; i < problem.points.size(); i += 7) problem.points[i].fixed = true;
  for (std::size_t i = 1; i < problem.points.size(); i += 7) problem.points[i].prior_sigma = 0.1;
  problem.observations.push_back(problem.observations[problem.observations.size() / 2]);
  problem.observations.back().measurement.pixel.x() += 1;
  if (rolling) {
    scene.camera.readout_s = 0.03;
    for (BundleCamera& c : problem.cameras) c.twist << uniformVector(random, 0.5), uniformVector(random, 0.5);
    for (BundlePoint& p : problem.points) p.host_origin = uniformVector(random, 0.02);
  }
  structureBundle(scene.camera, problem, most_dense, made.structure);
  for (const BundleCamera& c : problem.cameras) {
    made.state.rotations.push_back(c.world_T_camera.rotation);
    made.state.frames.push_back(cameraFrame(c.world_T_camera));
  }
  for (const StructuredPoint& p : made.structure.points)
    made.state.inverse_depths.push_back(problem.points[static_cast<std::size_t>(p.index)].inverse_depth);
  made.linearization.origin = {0.3, -0.2, 0.5};
  linearizeBundle(scene.camera, made.structure, made.state, huber, damping, made.linearization);
  return made;
}

// A state with each unknown camera moved by [centre; turn] (world axes) and each depth changed.
BundleState moved(const Linearized& from, const Eigen::VectorXd& changes) {
  BundleState state = from.state;
  const std::size_t unknowns = from.structure.camera_of_unknown.size();
  for (std::size_t k = 0; k < unknowns; ++k) {
    const auto c = static_cast<std::size_t>(from.structure.camera_of_unknown[k]);
    const Vector6d change = changes.segment<6>(static_cast<Eigen::Index>(6 * k));
    state.frames[c] = {(rotationExp(change.tail<3>()) * state.rotations[c]).toRotationMatrix(),
                       state.frames[c].centre + change.head<3>()};
  }
  for (std::size_t i = 0; i < state.inverse_depths.size(); ++i) {
    if (from.structure.points[i].free) state.inverse_depths[i] += changes(static_cast<Eigen::Index>(6 * unknowns + i));
  }
  return state;
}

// All weighted residuals at a state with the weights of the start, priors last.
Eigen::VectorXd residualsAt(const Linearized& from, const BundleState& state) {
  std::vector<double> residuals;
  const auto add = [&](const BundleState& at, std::size_t i, const StructuredObservation& o,
                       Eigen::Vector2d& residual) {
    const StructuredPoint& p = from.structure.points[i];
    const CameraFrame& host = at.frames[static_cast<std::size_t>(p.host)];
    CameraFrame row, from_row = host;
    const CameraFrame& target = targetFrame(from.structure, at, o, row);
    from_row.centre += host.world_R_camera * p.host_origin;
    return sightResidual(from.scene.camera, o.measured, target,
                         sight(from_row, target, p.host_bearing, at.inverse_depths[i]), residual, nullptr);
  };
  for (std::size_t i = 0; i < from.structure.points.size(); ++i) {
    const StructuredPoint& p = from.structure.points[i];
    for (int k = p.first_observation; k < p.end_observation; ++k) {
      const StructuredObservation& o = from.structure.observations[static_cast<std::size_t>(k)];
      Eigen::Vector2d before = Eigen::Vector2d::Zero(), now = before;
      EXPECT_TRUE(add(from.state, i, o, before) && add(state, i, o, now));
      now *= std::sqrt(huberWeight(before.norm(), huber));
      residuals.insert(residuals.end(), {now.x(), now.y()});
    }
  }
  for (std::size_t i = 0; i < from.structure.points.size(); ++i) {
    const StructuredPoint& p = from.structure.points[i];
    residuals.push_back(std::sqrt(p.prior_information) * (state.inverse_depths[i] - p.prior_inverse_depth));
  }
  return Eigen::Map<Eigen::VectorXd>(residuals.data(), static_cast<Eigen::Index>(residuals.size()));
}

// Derivative of all residuals by all unknowns (6 a camera, then the depths), by differences.
Eigen::MatrixXd numericJacobian(const Linearized& from) {
  const auto unknowns =
      static_cast<Eigen::Index>(6 * from.structure.camera_of_unknown.size() + from.structure.points.size());
  Eigen::MatrixXd jacobian(residualsAt(from, from.state).size(), unknowns);
  constexpr double kStep = 1e-6;
  for (Eigen::Index j = 0; j < unknowns; ++j) {
    const Eigen::VectorXd change = kStep * Eigen::VectorXd::Unit(unknowns, j);
    jacobian.col(j) = (residualsAt(from, moved(from, change)) - residualsAt(from, moved(from, -change))) / (2 * kStep);
  }
  return jacobian;
}

class BundleLinearizationOfModel : public testing::TestWithParam<CameraModel> {};

// The step by way of the reduced system is that of the whole system made from differences.
TEST_P(BundleLinearizationOfModel, StepMatchesTheWholeSystemFromDifferences) {
  for (const int most_dense : {30, 0}) {
    for (const double damping : {1e-3, 1.0}) {
      BundleSceneOptions options;
      options.model = GetParam();
      options.cameras = 4;
      options.points = 40;
      options.noise = 1;
      Linearized made = linearized(options, damping, 3, most_dense, damping == 1.0);
      EXPECT_EQ(made.structure.dense, most_dense > 0);
      const Eigen::MatrixXd jacobian = numericJacobian(made);
      const Eigen::VectorXd gradient = jacobian.transpose() * residualsAt(made, made.state);
      Eigen::MatrixXd information = jacobian.transpose() * jacobian;
      information.diagonal() += damping * information.diagonal().cwiseMax(1e-6);
      const Eigen::VectorXd expected = -information.ldlt().solve(gradient);

      ReducedSolver solver;
      solver.prepare(made.structure);
      CameraStep step;
      ASSERT_TRUE(solver.solve(made.structure, made.state, made.linearization, damping, step));
      std::vector<double> depth_changes;
      changeDepths(made.structure, made.linearization, step.twists, depth_changes);
      Eigen::VectorXd found(expected.size());
      found << step.changes,
          Eigen::Map<Eigen::VectorXd>(depth_changes.data(), static_cast<Eigen::Index>(depth_changes.size()));
      EXPECT_LT((found - expected).norm(), 1e-5 * expected.norm());
      EXPECT_GT(expected.norm(), 1e-3);
    }
  }
}

TEST_P(BundleLinearizationOfModel, CostIsTheSameWithAndWithoutDerivatives) {
  BundleSceneOptions options;
  options.model = GetParam();
  options.noise = 1;
  const Linearized made = linearized(options, 0, 4);
  EXPECT_NEAR(bundleCost(made.scene.camera, made.structure, made.state, huber), made.linearization.cost,
              1e-10 * made.linearization.cost);
}

INSTANTIATE_TEST_SUITE_P(Models, BundleLinearizationOfModel,
                         testing::Values(CameraModel::pinhole_radial_tangential, CameraModel::kannala_brandt));

TEST(BundleStructure, KeepsWhatTakesPartAndNamesItsBlocks) {
  Random random(5);
  BundleSceneOptions options;
  options.cameras = 8;
  const BundleScene scene = makeBundleScene(random, options);
  for (const int most_dense : {30, 0}) {
    BundleProblem problem = scene.truth;
    problem.points[3].fixed = true;
    BundleStructure structure;
    structureBundle(scene.camera, problem, most_dense, structure);
    EXPECT_EQ(structure.camera_of_unknown, (std::vector<int>{2, 3, 4, 5, 6, 7}));
    EXPECT_EQ(structure.points.size(), problem.points.size());
    for (const StructuredPoint& p : structure.points) {
      const int* block = structure.blocks.data() + p.first_block;
      for (int row = p.first_viewer; row < p.end_viewer; ++row) {
        for (int column = p.first_viewer; column <= row; ++column, ++block) {
          const BlockPlace place = structure.places[static_cast<std::size_t>(*block)];
          EXPECT_EQ(place.row, structure.viewers[static_cast<std::size_t>(row)]);
          EXPECT_EQ(place.column, structure.viewers[static_cast<std::size_t>(column)]);
        }
      }
    }
  }
}

}  // namespace
}  // namespace edgeslam::test
