#include "adjustment/bundle_lines.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "adjustment/damping.h"
#include "adjustment/index.h"
#include "adjustment/line_residual.h"

namespace edgeslam {
namespace {

Eigen::Vector4d byChange(const LineBasis& basis, const LineDerivatives& derivatives) {
  Eigen::Vector4d by_change;
  by_change.head<2>().noalias() = basis.transpose() * derivatives.by_point;
  by_change.tail<2>().noalias() = basis.transpose() * derivatives.by_direction;
  return by_change;
}

// `lever`: from the twists' origin to the camera's centre.
Vector6d byTwist(const Eigen::Vector3d& lever, const LineDerivatives& derivatives) {
  Vector6d by_twist;
  by_twist.head<3>() = -derivatives.by_point;
  by_twist.tail<3>() = derivatives.by_turn - lever.cross(derivatives.by_point);
  return by_twist;
}

class LineLinearizer {
 public:
  LineLinearizer(const BundleStructure& structure, const BundleState& state, double huber, double damping,
                 BundleLinearization& linearization)
      : structure_(structure), state_(state), huber_(huber), damping_(damping), linearization_(linearization) {}

  void addLine(std::size_t index) {
    const StructuredLine& line = structure_.lines[index];
    EliminatedLine& eliminated = linearization_.lines[index];
    eliminated = EliminatedLine();
    eliminated.basis = lineBasis(state_.lines[index].direction);
    information_.setZero();
    for (int v = line.first_viewer; v < line.end_viewer; ++v) linearization_.line_mixed[at(v)].setZero();
    for (int k = line.first_observation; k < line.end_observation; ++k)
      addObservation(line, state_.lines[index], eliminated, structure_.line_observations[at(k)]);
    if (line.free) eliminate(line, eliminated);
  }

 private:
  void addObservation(const StructuredLine& line, const SpaceLine& in_world, EliminatedLine& eliminated,
                      const StructuredLineObservation& o) {
    CameraFrame row;
    const CameraFrame& target = targetFrame(structure_, state_, o, row);
    double residual = 0;
    LineDerivatives derivatives;
    if (!lineResidual(in_world, target.centre, target.world_R_camera * o.bearing, o.sigma, residual, &derivatives))
      return;
    linearization_.cost += 0.5 * huberLoss(residual * residual, huber_);
    const double weight = huberWeight(std::abs(residual), huber_);
    const Eigen::Vector4d by_change = byChange(eliminated.basis, derivatives);
    const Eigen::Vector4d weighted_by_change = weight * by_change;
    information_.noalias() += weighted_by_change * by_change.transpose();
    eliminated.gradient += residual * weighted_by_change;
    if (o.viewer < 0) return;
    const Vector6d by_twist = byTwist(target.centre - linearization_.origin, derivatives);
    const Vector6d weighted_by_twist = weight * by_twist;
    const int viewer = line.first_viewer + o.viewer;
    const int unknown = structure_.line_viewers[at(viewer)];
    linearization_.camera_gradient.segment<6>(6 * unknown) += residual * weighted_by_twist;
    linearization_.diagonal[at(unknown)].noalias() += weighted_by_twist * by_twist.transpose();
    linearization_.line_mixed[at(viewer)].noalias() += by_twist * weighted_by_change.transpose();
  }

  void eliminate(const StructuredLine& line, EliminatedLine& eliminated) {
    if (!(information_.trace() > 0)) return;
    information_.diagonal() += damping_ * information_.diagonal().cwiseMax(least_information);
    const Eigen::LLT<Eigen::Matrix4d> factor(information_);
    if (factor.info() != Eigen::Success) return;
    eliminated.inverse_information = factor.solve(Eigen::Matrix4d::Identity());
    const int* block = structure_.line_blocks.data() + line.first_block;
    for (int row = line.first_viewer; row < line.end_viewer; ++row) {
      const Matrix64d scaled = linearization_.line_mixed[at(row)] * eliminated.inverse_information;
      linearization_.gradient.segment<6>(6 * structure_.line_viewers[at(row)]).noalias() -=
          scaled * eliminated.gradient;
      for (int column = line.first_viewer; column <= row; ++column) {
        linearization_.blocks[at(*block++)].noalias() -= scaled * linearization_.line_mixed[at(column)].transpose();
      }
    }
  }

  const BundleStructure& structure_;
  const BundleState& state_;
  double huber_, damping_;
  BundleLinearization& linearization_;
  Eigen::Matrix4d information_ = Eigen::Matrix4d::Zero();  // of the line at hand
};

// Calls function(index, residual or null where seen end-on, its derivatives) for every observation with usable values.
template <typename Function>
void forEachResidual(const Camera& camera, const BundleProblem& problem, const Function& function) {
  for (std::size_t k = 0; k < problem.line_observations.size(); ++k) {
    const BundleLineObservation& o = problem.line_observations[k];
    const BundleLine& line = problem.lines[at(o.line)];
    if (!usable(line) || !usable(o)) continue;
    const BundleCamera& target = problem.cameras[at(o.camera)];
    CameraFrame frame = cameraFrame(target.world_T_camera);
    if (camera.readout_s != 0 && !target.twist.isZero(0)) {
      frame = rowFrame(frame, cameraFrame(rowPose(camera, target.twist, o.row)));
    }
    double residual = 0;
    LineDerivatives derivatives;
    const bool seen =
        lineResidual(line.line, frame.centre, frame.world_R_camera * o.bearing, o.sigma, residual, &derivatives);
    function(k, seen ? &residual : nullptr, derivatives);
  }
}

// Variances up to 1 / least_information; what is known well tells what is not.
Eigen::Matrix4d covarianceOf(const Eigen::Matrix4d& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> parts(information);
  const Eigen::Vector4d variances = parts.eigenvalues().cwiseMax(least_information).cwiseInverse();
  return parts.eigenvectors() * variances.asDiagonal() * parts.eigenvectors().transpose();
}

}  // namespace

double lineCost(const BundleStructure& structure, const BundleState& state, double huber) {
  double cost = 0;
  for (std::size_t i = 0; i < structure.lines.size(); ++i) {
    const StructuredLine& line = structure.lines[i];
    for (int k = line.first_observation; k < line.end_observation; ++k) {
      const StructuredLineObservation& o = structure.line_observations[at(k)];
      CameraFrame row;
      const CameraFrame& target = targetFrame(structure, state, o, row);
      double residual = 0;
      lineResidual(state.lines[i], target.centre, target.world_R_camera * o.bearing, o.sigma, residual, nullptr);
      cost += 0.5 * huberLoss(residual * residual, huber);
    }
  }
  return cost;
}

double lineCost(const Camera& camera, const BundleProblem& problem, double huber) {
  double cost = 0;
  forEachResidual(camera, problem, [&](std::size_t, const double* residual, const LineDerivatives&) {
    if (residual) cost += 0.5 * huberLoss(*residual * *residual, huber);
  });
  return cost;
}

void linearizeLines(const BundleStructure& structure, const BundleState& state, double huber, double damping,
                    BundleLinearization& linearization) {
  linearization.lines.resize(structure.lines.size());
  linearization.line_mixed.resize(structure.line_viewers.size());
  LineLinearizer linearizer(structure, state, huber, damping, linearization);
  for (std::size_t i = 0; i < structure.lines.size(); ++i) linearizer.addLine(i);
}

void changeLines(const BundleStructure& structure, const BundleLinearization& linearization,
                 const Eigen::VectorXd& twists, std::vector<Eigen::Vector4d>& changes) {
  changes.resize(structure.lines.size());
  for (std::size_t i = 0; i < structure.lines.size(); ++i) {
    const StructuredLine& line = structure.lines[i];
    Eigen::Vector4d gradient = linearization.lines[i].gradient;
    for (int viewer = line.first_viewer; viewer < line.end_viewer; ++viewer) {
      gradient.noalias() +=
          linearization.line_mixed[at(viewer)].transpose() * twists.segment<6>(6 * structure.line_viewers[at(viewer)]);
    }
    changes[i].noalias() = -linearization.lines[i].inverse_information * gradient;
  }
}

void assessLines(const Camera& camera, const BundleProblem& problem, double huber, BundleResult& result) {
  result.line_errors.assign(problem.line_observations.size(), std::numeric_limits<double>::infinity());
  std::vector<Eigen::Matrix4d> information(problem.lines.size(), Eigen::Matrix4d::Zero());
  std::vector<char> is_observed(problem.lines.size(), false);
  forEachResidual(camera, problem, [&](std::size_t k, const double* residual, const LineDerivatives& derivatives) {
    const std::size_t line = at(problem.line_observations[k].line);
    is_observed[line] = true;
    if (!residual) return;
    const double error = std::abs(*residual);
    result.line_errors[k] = error;
    const Eigen::Vector4d by_change = byChange(lineBasis(problem.lines[line].line.direction), derivatives);
    information[line] += huberWeight(error, huber) * by_change * by_change.transpose();
  });
  for (std::size_t i = 0; i < problem.lines.size(); ++i) {
    result.line_covariances.push_back(is_observed[i] ? covarianceOf(information[i]) : Eigen::Matrix4d::Zero());
  }
}

}  // namespace edgeslam
