#include "inertia/turn_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "geometry/rolling_shutter.h"
#include "inertia/pose_errors.h"

namespace edgeslam {
namespace {

constexpr int most_iterations = 20;

struct TimedError {
  std::int64_t from_ns = 0;
  double seconds = 0;
  TurnError turn;
};

std::vector<TimedError> errorsOf(const std::vector<CameraTurn>& turns, const std::vector<InertialSample>& samples,
                                 const TurnParameters& parameters) {
  const GyroscopeTurns gyroscope(samples, parameters.rate_bias);
  const std::int64_t offset_ns = std::llround(parameters.offset_s * 1e9);
  std::vector<TimedError> errors;
  for (const CameraTurn& seen : turns) {
    const std::optional<GyroscopeTurn> felt = gyroscope.between(seen.from_ns + offset_ns, seen.to_ns + offset_ns);
    if (felt) errors.push_back({seen.from_ns, secondsOf(seen), turnError(parameters, seen, *felt)});
  }
  return errors;
}

std::vector<double> weightsOf(const std::vector<TimedError>& errors) {
  std::vector<double> lengths;
  lengths.reserve(errors.size());
  for (const TimedError& timed : errors) lengths.push_back(timed.turn.error.norm());
  return cauchyWeights(lengths);
}

struct TurnEquations {
  Matrix7d information = Matrix7d::Zero();
  Vector7d gradient = Vector7d::Zero();
};

TurnEquations turnEquations(const std::vector<TimedError>& errors, const std::vector<double>& weights) {
  TurnEquations equations;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const TurnError& turn = errors[i].turn;
    equations.information += weights[i] * turn.by_parameters.transpose() * turn.by_parameters;
    equations.gradient += weights[i] * turn.by_parameters.transpose() * turn.error;
  }
  return equations;
}

// Gradients of parts of the recording one after another: at the solution they add up to nothing, and scatter.
std::vector<Vector7d> gradientsOfParts(const std::vector<TimedError>& errors, const std::vector<double>& weights) {
  const std::int64_t part_ns = partLength(errors.front().from_ns, errors.back().from_ns);
  std::vector<Vector7d> gradients;
  std::int64_t part = -1;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const std::int64_t now = (errors[i].from_ns - errors.front().from_ns) / part_ns;
    if (now != part) gradients.emplace_back(Vector7d::Zero());
    part = now;
    gradients.back() += weights[i] * errors[i].turn.by_parameters.transpose() * errors[i].turn.error;
  }
  return gradients;
}

// Covariance of the gradient by a bias that walks about the one that it had in the middle: each of its steps, `walk`
// [rad/s^2/sqrt(Hz)] large, goes into all turns on its side.
Matrix7d gradientOfWalk(const std::vector<TimedError>& errors, const std::vector<double>& weights, double walk) {
  using Matrix73d = Eigen::Matrix<double, 7, 3>;
  Matrix7d covariance = Matrix7d::Zero();
  const std::size_t count = errors.size(), middle = count / 2;
  const auto add = [&](const Matrix73d& by_steps, std::size_t from, std::size_t to) {
    const double seconds = static_cast<double>(errors[to].from_ns - errors[from].from_ns) * 1e-9;
    covariance += seconds * walk * walk * by_steps * by_steps.transpose();
  };
  const auto ofTurn = [&](std::size_t i) -> Matrix73d {
    const Matrix37d& by_parameters = errors[i].turn.by_parameters;
    return weights[i] * by_parameters.transpose() * by_parameters.middleCols<3>(3);
  };
  Matrix73d after = Matrix73d::Zero(), before = Matrix73d::Zero();
  for (std::size_t i = count - 1; i > middle; --i) add(after += ofTurn(i), i - 1, i);
  for (std::size_t i = 0; i < middle; ++i) add(before += ofTurn(i), i, i + 1);
  return covariance;
}

std::optional<Matrix7d> inverseOf(const Matrix7d& information) {
  // Units differ by orders of magnitude: each parameter in that of its own information.
  const Vector7d unit = information.diagonal().cwiseSqrt().cwiseMax(1e-12).cwiseInverse();
  const Eigen::LDLT<Matrix7d> factor(unit.asDiagonal() * information * unit.asDiagonal());
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 1e-9)) return std::nullopt;
  return unit.asDiagonal() * factor.solve(Matrix7d::Identity()) * unit.asDiagonal();
}

// Of what the parts add, each as independent of the others; larger by what the fit took up itself, and what it cannot
// see.
Matrix7d scatterOf(const std::vector<Vector7d>& gradients, std::size_t unknowns) {
  Matrix7d scatter = Matrix7d::Zero();
  for (const Vector7d& gradient : gradients) scatter += gradient * gradient.transpose();
  const double parts = static_cast<double>(gradients.size());
  return unseen_times * unseen_times * parts / (parts - static_cast<double>(unknowns)) * scatter;
}

double coveredSeconds(const std::vector<TimedError>& errors) {
  double covered = 0;
  std::int64_t until_ns = errors.front().from_ns;
  for (const TimedError& timed : errors) {
    const std::int64_t end_ns = timed.from_ns + std::llround(timed.seconds * 1e9);
    covered += static_cast<double>(end_ns - std::max(until_ns, timed.from_ns)) * 1e-9;
    until_ns = end_ns;
  }
  return covered;
}

double rmsOf(const std::vector<TimedError>& errors, const std::vector<double>& weights) {
  double squares = 0, weight = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    squares += weights[i] * errors[i].turn.error.squaredNorm();
    weight += weights[i];
  }
  return std::sqrt(squares / (3 * weight));
}

}  // namespace

TurnParameters changed(const TurnParameters& parameters, const Vector7d& change) {
  TurnParameters now = parameters;
  now.imu_R_camera = (parameters.imu_R_camera * rotationExp(change.head<3>())).normalized();
  now.rate_bias += change.segment<3>(3);
  now.offset_s += change(6);
  return now;
}

TurnError turnError(const TurnParameters& parameters, const CameraTurn& seen, const GyroscopeTurn& felt) {
  const Eigen::Quaterniond& imu_R_camera = parameters.imu_R_camera;
  const Eigen::Quaterniond seen_by_unit = imu_R_camera * seen.rotation * imu_R_camera.conjugate();
  TurnError turn;
  turn.error = rotationLog((felt.rotation.conjugate() * seen_by_unit).normalized());
  // How a small rotation on the right, or on the left, of what is left changes its vector.
  const Eigen::Matrix3d by_right = rightJacobian(turn.error).inverse(), by_left = by_right.transpose();
  const Eigen::Matrix3d turned_back = seen.rotation.conjugate().toRotationMatrix();
  turn.by_parameters.leftCols<3>() =
      by_right * imu_R_camera.toRotationMatrix() * (turned_back - Eigen::Matrix3d::Identity());
  turn.by_parameters.middleCols<3>(3) = -by_left * felt.by_bias;
  turn.by_parameters.col(6) = -by_left * (felt.to_rate - felt.rotation.conjugate() * felt.from_rate);
  return turn;
}

std::optional<TurnFit> fitTurns(const std::vector<CameraTurn>& turns, const std::vector<InertialSample>& samples,
                                const TurnParameters& start, double rate_walk, bool rotation_is_known) {
  const std::size_t unknowns = rotation_is_known ? 4 : 7;
  TurnFit fit;
  fit.parameters = start;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    std::vector<TimedError> errors = errorsOf(turns, samples, fit.parameters);
    if (errors.size() < fewest_turns) return std::nullopt;
    if (rotation_is_known) {
      for (TimedError& timed : errors) timed.turn.by_parameters.leftCols<3>().setZero();
    }
    const std::vector<double> weights = weightsOf(errors);
    TurnEquations equations = turnEquations(errors, weights);
    if (rotation_is_known) equations.information.topLeftCorner<3, 3>().setIdentity();
    const std::optional<Matrix7d> inverse = inverseOf(equations.information);
    const std::vector<Vector7d> gradients = gradientsOfParts(errors, weights);
    if (!inverse || gradients.size() <= unknowns) return std::nullopt;
    const Matrix7d scatter = scatterOf(gradients, unknowns) + gradientOfWalk(errors, weights, rate_walk);
    fit.covariance = *inverse * scatter * *inverse;
    fit.turns = errors.size();
    fit.seconds = coveredSeconds(errors);
    fit.error_rad = rmsOf(errors, weights);
    const Vector7d change = -*inverse * equations.gradient;
    fit.parameters = changed(fit.parameters, change);
    if (change.norm() < 1e-8) break;
  }
  return fit;
}

}  // namespace edgeslam
