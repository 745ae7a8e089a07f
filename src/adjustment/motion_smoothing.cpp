#include "adjustment/motion_smoothing.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace edgeslam {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
// A band stays one: nothing is gained by another order.
using BandSolver = Eigen::SimplicialLDLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>>;

struct Equations {
  double cost = 0;
  std::vector<Matrix6d> diagonal, one_before, two_before;  // by frame: with itself and those before it
  std::vector<Vector6d> gradient;
};

Equations linearize(const FrameEquations& measured, const std::vector<SmoothedFrame>& frames) {
  Equations all;
  const std::size_t count = frames.size();
  all.diagonal.assign(count, Matrix6d::Zero());
  all.one_before = all.two_before = all.diagonal;
  all.gradient.assign(count, Vector6d::Zero());
  for (std::size_t i = 0; i < count; ++i) {
    if (frames[i].is_fixed) continue;
    const PoseEquations frame = measured(i, frames[i].world_T_camera);
    all.cost += frame.cost;
    all.diagonal[i] += frame.information;
    all.gradient[i] += frame.gradient;
  }
  for (std::size_t i = 2; i < count; ++i) {
    const SpeedChange change = speedChange(frames[i - 2], frames[i - 1], frames[i]);
    all.cost += change.residual.squaredNorm();
    const auto& by = change.by_frame;
    for (std::size_t k = 0; k < 3; ++k) {
      all.diagonal[i - 2 + k].noalias() += by[k].transpose() * by[k];
      all.gradient[i - 2 + k].noalias() += by[k].transpose() * change.residual;
    }
    all.one_before[i - 1].noalias() += by[1].transpose() * by[0];
    all.one_before[i].noalias() += by[2].transpose() * by[1];
    all.two_before[i].noalias() += by[2].transpose() * by[0];
  }
  return all;
}

// Steps of the frames that are not fixed; empty where there is none.
std::vector<Vector6d> solve(const Equations& equations, const std::vector<SmoothedFrame>& frames, double damping) {
  std::vector<int> row(frames.size(), -1);
  int rows = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].is_fixed) row[i] = 6 * rows++;
  }
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(rows) * 36 * 3);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(6 * rows);
  const auto add = [&](std::size_t i, std::size_t j, const Matrix6d& block) {
    if (row[i] < 0 || row[j] < 0) return;
    for (int a = 0; a < 6; ++a) {
      for (int b = 0; b < 6; ++b) entries.emplace_back(row[i] + a, row[j] + b, block(a, b));
    }
  };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (row[i] < 0) continue;
    Matrix6d own = equations.diagonal[i];
    own.diagonal() *= 1 + damping;
    add(i, i, own);
    if (i >= 1) add(i, i - 1, equations.one_before[i]);
    if (i >= 2) add(i, i - 2, equations.two_before[i]);
    right.segment<6>(row[i]) = -equations.gradient[i];
  }
  Sparse matrix(6 * rows, 6 * rows);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const BandSolver solver(matrix);
  std::vector<Vector6d> steps;
  if (solver.info() != Eigen::Success) return steps;
  const Eigen::VectorXd solution = solver.solve(right);
  if (!solution.allFinite()) return steps;
  steps.assign(frames.size(), Vector6d::Zero());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (row[i] >= 0) steps[i] = solution.segment<6>(row[i]);
  }
  return steps;
}

}  // namespace

SpeedChange speedChange(const SmoothedFrame& before, const SmoothedFrame& at, const SmoothedFrame& after) {
  const double first_s = at.time_s - before.time_s, second_s = after.time_s - at.time_s;
  const double root_s = std::sqrt(0.5 * (first_s + second_s));
  const double position = 1 / (at.walk.position * root_s), rotation = 1 / (at.walk.rotation * root_s);
  const Eigen::Matrix3d world_R[3] = {before.world_T_camera.rotation.toRotationMatrix(),
                                      at.world_T_camera.rotation.toRotationMatrix(),
                                      after.world_T_camera.rotation.toRotationMatrix()};
  const Eigen::Vector3d first = at.world_T_camera.translation - before.world_T_camera.translation;
  const Eigen::Vector3d second = after.world_T_camera.translation - at.world_T_camera.translation;
  const Eigen::Vector3d turn_first =
      rotationLog(before.world_T_camera.rotation.conjugate() * at.world_T_camera.rotation);
  const Eigen::Vector3d turn_second =
      rotationLog(at.world_T_camera.rotation.conjugate() * after.world_T_camera.rotation);
  SpeedChange change;
  change.residual << position * (second / second_s - first / first_s),
      rotation * (turn_second / second_s - turn_first / first_s);
  // From frame to frame a camera turns little: the derivative of the logarithm is taken to the first order.
  const auto byLatter = [](const Eigen::Vector3d& turn) -> Eigen::Matrix3d {
    return Eigen::Matrix3d::Identity() + 0.5 * skew(turn);
  };
  const auto byFormer = [](const Eigen::Vector3d& turn) -> Eigen::Matrix3d {
    return -Eigen::Matrix3d::Identity() + 0.5 * skew(turn);
  };
  for (Matrix6d& by : change.by_frame) by.setZero();
  change.by_frame[0].topLeftCorner<3, 3>() = position / first_s * world_R[0];
  change.by_frame[1].topLeftCorner<3, 3>() = -position * (1 / first_s + 1 / second_s) * world_R[1];
  change.by_frame[2].topLeftCorner<3, 3>() = position / second_s * world_R[2];
  change.by_frame[0].bottomRightCorner<3, 3>() = -rotation / first_s * byFormer(turn_first);
  change.by_frame[1].bottomRightCorner<3, 3>() =
      rotation * (byFormer(turn_second) / second_s - byLatter(turn_first) / first_s);
  change.by_frame[2].bottomRightCorner<3, 3>() = rotation / second_s * byLatter(turn_second);
  return change;
}

void smoothMotion(const FrameEquations& equations, int most_iterations, std::vector<SmoothedFrame>& frames) {
  constexpr double least_damping = 1e-6, most_damping = 1e3;
  constexpr double hardly = 1e-4;  // share of the cost: with a step that gains less it is done
  double damping = least_damping;
  Equations here = linearize(equations, frames);
  for (int iteration = 0; iteration < most_iterations && damping <= most_damping; ++iteration) {
    const std::vector<Vector6d> steps = solve(here, frames, damping);
    if (steps.empty()) {
      damping *= 30;
      continue;
    }
    std::vector<SmoothedFrame> moved = frames;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (!frames[i].is_fixed) moved[i].world_T_camera = retract(frames[i].world_T_camera, steps[i]);
    }
    Equations there = linearize(equations, moved);
    if (!(there.cost < here.cost)) {
      damping *= 30;
      continue;
    }
    const bool is_done = here.cost - there.cost < hardly * here.cost;
    frames = std::move(moved);
    here = std::move(there);
    if (is_done) return;
    damping = std::max(least_damping, 0.1 * damping);
  }
}

}  // namespace edgeslam
