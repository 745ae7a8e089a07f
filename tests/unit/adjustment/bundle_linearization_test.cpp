// P19: the reduced normal equations are those of the whole problem.
#include "adjustment/bundle_linearization.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "adjustment/bundle_lines.h"
#include "adjustment/line_residual.h"
#include "adjustment/reduced_solver.h"
#include "synthetic_bundle.h"

namespace edgeslam::test {
namespace {

struct Linearized {
  BundleScene scene;
  BundleStructure structure;
  BundleState state;
  BundleLinearization linearization;
};

// Lines before the cameras of a scene, each seen by some of them with an error; some are fixed.
void addLines(Random& random, int lines, BundleProblem& problem) {
  for (int i = 0; i < lines; ++i) {
    BundleLine line;
    line.line = {uniformVector(random, 1) + Eigen::Vector3d(0.5, 0, 4), direction(random)};
    line.fixed = i % 5 == 4;
    problem.lines.push_back(line);
    for (int c = i % 2; c < static_cast<int>(problem.cameras.size()); ++c) {
      for (const double along : {-0.5, 0.5}) {
        BundleLineObservation o;
        o.camera = c;
        o.line = i;
        const Eigen::Vector3d end = line.line.point + along * line.line.direction;
        const Pose& world_T_camera = problem.cameras[static_cast<std::size_t>(c)].world_T_camera;
        o.bearing = ((world_T_camera.inverse() * end).normalized() + uniformVector(random, 0.005)).normalized();
        o.row = uniform(random, 0, 480);
        o.sigma = uniform(random, 1e-3, 3e-3);
        problem.line_observations.push_back(o);
      }
    }
  }
}

// Fixed and free cameras, points and lines, priors, and an observation given twice.
Linearized linearized(const BundleSceneOptions& options, double damping, std::uint64_t seed, int most_dense = 30,
                      bool rolling = false, int lines = 0) {
  Random random(seed);
  Linearized made;
  BundleScene& scene = made.scene = makeBundleScene(random, options);
  scene.truth = perturbedProblem(random, scene.truth, 0.02, 0.01);
  BundleProblem& problem = scene.truth;
  for (std::size_t i = 0; i < problem.points.size(); i += 7) problem.points[i].fixed = true;
  for (std::size_t i = 1; i < problem.points.size(); i += 7) problem.points[i].prior_sigma = 0.1;
  if (!problem.observations.empty()) {
    problem.observations.push_back(problem.observations[problem.observations.size() / 2]);
    problem.observations.back().measurement.pixel.x() += 1;
  }
  addLines(random, lines, problem);
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
  for (const StructuredLine& line : made.structure.lines)
    made.state.lines.push_back(problem.lines[static_cast<std::size_t>(line.index)].line);
  made.linearization.origin = {0.3, -0.2, 0.5};
  linearizeBundle(scene.camera, problem, made.structure, made.state, test_huber, damping, made.linearization);
  return made;
}

// A state with each unknown camera moved by [centre; turn] (world axes), and each depth and line changed.
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
  const std::size_t first = 6 * unknowns + state.inverse_depths.size();
  for (std::size_t i = 0; i < state.lines.size(); ++i) {
    if (!from.structure.lines[i].free) continue;
    state.lines[i] = movedLine(state.lines[i], changes.segment<4>(static_cast<Eigen::Index>(first + 4 * i)));
  }
  return state;
}

double lineResidualAt(const Linearized& from, const BundleState& state, std::size_t line,
                      const StructuredLineObservation& o) {
  CameraFrame row;
  const CameraFrame& target = targetFrame(from.structure, state, o, row);
  double residual = 0;
  EXPECT_TRUE(
      lineResidual(state.lines[line], target.centre, target.world_R_camera * o.bearing, o.sigma, residual, nullptr));
  return residual;
}

// All weighted residuals at a state with the weights of the start, priors and lines last.
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
      now *= std::sqrt(huberWeight(before.norm(), test_huber));
      residuals.insert(residuals.end(), {now.x(), now.y()});
    }
  }
  for (std::size_t i = 0; i < from.structure.points.size(); ++i) {
    const StructuredPoint& p = from.structure.points[i];
    residuals.push_back(std::sqrt(p.prior_information) * (state.inverse_depths[i] - p.prior_inverse_depth));
  }
  for (std::size_t i = 0; i < from.structure.lines.size(); ++i) {
    const StructuredLine& line = from.structure.lines[i];
    for (int k = line.first_observation; k < line.end_observation; ++k) {
      const StructuredLineObservation& o = from.structure.line_observations[static_cast<std::size_t>(k)];
      const double weight = huberWeight(std::abs(lineResidualAt(from, from.state, i, o)), test_huber);
      residuals.push_back(std::sqrt(weight) * lineResidualAt(from, state, i, o));
    }
  }
  return Eigen::Map<Eigen::VectorXd>(residuals.data(), static_cast<Eigen::Index>(residuals.size()));
}

// Derivative of all residuals by all unknowns (6 a camera, then the depths, then 4 a line), by differences.
Eigen::MatrixXd numericJacobian(const Linearized& from) {
  const auto unknowns = static_cast<Eigen::Index>(6 * from.structure.camera_of_unknown.size() +
                                                  from.structure.points.size() + 4 * from.structure.lines.size());
  Eigen::MatrixXd jacobian(residualsAt(from, from.state).size(), unknowns);
  constexpr double kStep = 1e-6;
  for (Eigen::Index j = 0; j < unknowns; ++j) {
    const Eigen::VectorXd change = kStep * Eigen::VectorXd::Unit(unknowns, j);
    jacobian.col(j) = (residualsAt(from, moved(from, change)) - residualsAt(from, moved(from, -change))) / (2 * kStep);
  }
  return jacobian;
}

// The step by way of the reduced system is that of the whole system made from differences.
void expectStepOfTheWholeSystem(const Linearized& made, double damping) {
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
  std::vector<Eigen::Vector4d> line_changes;
  changeLines(made.structure, made.linearization, step.twists, line_changes);
  Eigen::VectorXd found(expected.size());
  found << step.changes,
      Eigen::Map<Eigen::VectorXd>(depth_changes.data(), static_cast<Eigen::Index>(depth_changes.size())),
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(4 * line_changes.size()));
  for (std::size_t i = 0; i < line_changes.size(); ++i)
    found.segment<4>(found.size() - static_cast<Eigen::Index>(4 * (line_changes.size() - i))) = line_changes[i];
  EXPECT_LT((found - expected).norm(), 1e-5 * expected.norm());
  EXPECT_GT(expected.norm(), 1e-3);
}

class BundleLinearizationOfModel : public testing::TestWithParam<CameraModel> {};

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
      expectStepOfTheWholeSystem(made, damping);
    }
  }
}

// Likewise with lines, beside points and alone, and with readout or without it.
TEST_P(BundleLinearizationOfModel, StepWithLinesMatchesTheWholeSystemFromDifferences) {
  for (const int most_dense : {30, 0}) {
    for (const bool rolling : {false, true}) {
      for (const int points : {0, 40}) {
        BundleSceneOptions options;
        options.model = GetParam();
        options.cameras = 5;
        options.points = points;
        options.noise = 1;
        const double damping = points ? 1e-3 : 1.0;
        const Linearized made = linearized(options, damping, 6, most_dense, rolling, 10);
        EXPECT_EQ(made.structure.lines.size(), 10);
        EXPECT_EQ(made.structure.dense, most_dense > 0);
        EXPECT_EQ(!made.structure.rows.empty(), rolling);
        expectStepOfTheWholeSystem(made, damping);
      }
    }
  }
}

TEST_P(BundleLinearizationOfModel, CostIsTheSameWithAndWithoutDerivatives) {
  BundleSceneOptions options;
  options.model = GetParam();
  options.noise = 1;
  const Linearized made = linearized(options, 0, 4, 30, false, 10);
  EXPECT_NEAR(bundleCost(made.scene.camera, made.scene.truth, made.structure, made.state, test_huber),
              made.linearization.cost, 1e-10 * made.linearization.cost);
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
    addLines(random, 10, problem);
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
    EXPECT_EQ(structure.lines.size(), 10);
    for (const StructuredLine& line : structure.lines) {
      const int* block = structure.line_blocks.data() + line.first_block;
      EXPECT_EQ(line.end_viewer - line.first_viewer, 6);
      for (int row = line.first_viewer; row < line.end_viewer; ++row) {
        for (int column = line.first_viewer; column <= row; ++column, ++block) {
          const BlockPlace place = structure.places[static_cast<std::size_t>(*block)];
          EXPECT_EQ(place.row, structure.line_viewers[static_cast<std::size_t>(row)]);
          EXPECT_EQ(place.column, structure.line_viewers[static_cast<std::size_t>(column)]);
        }
      }
    }
  }
}

}  // namespace
}  // namespace edgeslam::test
