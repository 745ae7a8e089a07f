#include "mapping/inertial_alignment_estimate.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/median.h"
#include "geometry/squared.h"
#include "geometry/tangents.h"
#include "mapping/inertial_terms.h"

namespace edgeslam {
namespace {

using Matrix36d = Eigen::Matrix<double, 3, 6>;

constexpr double bias_change_prior = 0.1;  // of biases that are known, as a share of unknown ones: they walk
constexpr double turn_sigma = 1e-3;        // of keyframes against each other [rad]
constexpr double huber = 2;
constexpr double three_normal_median = 2.366;  // of the squared norm of three standard normal variables
constexpr double largest_turn_error = 0.3;     // of what the gyroscope contradicts, share of the turns, and [rad]
constexpr double largest_turn_error_rad = 0.1;
constexpr double least_scale_sigma = 3e-3;  // of what is known, share of it: the map bends
constexpr int iterations = 8;

// Of one world, the latest ones, ascending.
std::vector<const Keyframe*> latestKeyframes(const Map& map, int world, int most) {
  std::vector<const Keyframe*> latest;
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.world == world) latest.push_back(&keyframe);
  }
  const auto count = static_cast<std::ptrdiff_t>(latest.size());
  latest.erase(latest.begin(), latest.begin() + std::max<std::ptrdiff_t>(0, count - most));
  return latest;
}

// How far the turns of keyframes and of the gyroscope differ, and its bias, which explains most of that.
struct RateBias {
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  double sigma = unknown_rate_bias;
  double turned = 0, contradicted = 0;  // root of the sum of squares [rad]
};

RateBias estimateRateBias(const std::vector<const Keyframe*>& keyframes, const Map& map,
                          const Eigen::Quaterniond& camera_R_imu, const InertialBias& start, double prior_sigma) {
  RateBias estimate;
  estimate.bias = start.rate;
  for (int iteration = 0; iteration < 3; ++iteration) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Identity() / squared(prior_sigma);
    Eigen::Vector3d gradient = (estimate.bias - start.rate) / squared(prior_sigma);
    estimate.turned = estimate.contradicted = 0;
    for (const Keyframe* keyframe : keyframes) {
      const Keyframe* before = map.keyframes.find(keyframe->inertia.from);
      if (!before) continue;
      const PreintegratedMotion motion = withBias(keyframe->inertia.motion, {estimate.bias, start.force});
      const Eigen::Quaterniond seen = (before->world_T_camera.rotation * camera_R_imu).conjugate() *
                                      (keyframe->world_T_camera.rotation * camera_R_imu);
      const Eigen::Vector3d error = rotationLog((motion.rotation.conjugate() * seen).normalized());
      const Eigen::Matrix3d by_bias = motion.by_bias.topLeftCorner<3, 3>();
      const double variance = motion.covariance.topLeftCorner<3, 3>().trace() / 3 + squared(turn_sigma);
      const double norm = error.norm() / std::sqrt(variance);
      const double weight = (norm <= huber ? 1 : huber / norm) / variance;
      information += weight * by_bias.transpose() * by_bias;
      gradient -= weight * by_bias.transpose() * error;
      estimate.turned += squared(rotationLog(seen.normalized()).norm());
      estimate.contradicted += error.squaredNorm();
    }
    const Eigen::LLT<Eigen::Matrix3d> factor(information);
    estimate.bias -= factor.solve(gradient);
    estimate.sigma = std::sqrt(factor.solve(Eigen::Matrix3d::Identity()).trace() / 3);
  }
  estimate.turned = std::sqrt(estimate.turned);
  estimate.contradicted = std::sqrt(estimate.contradicted);
  return estimate;
}

// What three keyframes in a row say of the unknowns: scale, gravity and the accelerometer's bias.
struct Equation {
  Eigen::Vector3d by_scale;  // change of mean speed in map units
  double by_gravity = 0;     // its negative
  Eigen::Matrix3d by_bias;   // likewise, by the change of the bias
  Eigen::Vector3d constant;  // what the unit felt, and what its lever arm adds
  double visual_weight = 0;  // variance of by_scale for an error of 1 of each keyframe's place
  double inertial_variance = 0;

  Eigen::Vector3d error(double scale, const Eigen::Vector3d& gravity, const Eigen::Vector3d& bias_change) const {
    return scale * by_scale - by_gravity * gravity - by_bias * bias_change - constant;
  }
};

std::vector<Equation> equationsOf(const std::vector<const Keyframe*>& keyframes, const Map& map,
                                  const InertialUnit& unit, const InertialBias& bias) {
  const Eigen::Quaterniond camera_R_imu = unit.imu_T_camera.rotation.conjugate();
  const Eigen::Vector3d camera_t_imu = unit.imu_T_camera.inverse().translation;
  std::vector<Equation> equations;
  for (const Keyframe* keyframe : keyframes) {
    const std::optional<SpeedChange> change = speedChangeTo(map, *keyframe, bias, camera_R_imu);
    if (!change || change->keyframes[0] < keyframes.front()->id) continue;
    std::array<Pose, 3> poses;
    for (std::size_t k = 0; k < 3; ++k) poses[k] = map.keyframes[change->keyframes[k]].world_T_camera;
    const double t1 = change->seconds[0], t2 = change->seconds[1];
    const auto differ = [&](const auto& place) -> Eigen::Vector3d {
      return (place(2) - place(1)) / t2 - (place(1) - place(0)) / t1;
    };
    const auto centre = [&](std::size_t k) -> Eigen::Vector3d { return poses[k].translation; };
    const auto lever = [&](std::size_t k) -> Eigen::Vector3d { return poses[k].rotation * camera_t_imu; };
    const Matrix96d& one = map.keyframes[change->keyframes[1]].inertia.motion.by_bias;
    const Matrix96d& two = keyframe->inertia.motion.by_bias;
    Equation equation;
    equation.by_scale = differ(centre);
    equation.by_gravity = 0.5 * (t1 + t2);
    equation.by_bias =
        (poses[0].rotation * camera_R_imu).toRotationMatrix() * (one.block<3, 3>(3, 3) - one.block<3, 3>(6, 3) / t1) +
        (poses[1].rotation * camera_R_imu).toRotationMatrix() * two.block<3, 3>(6, 3) / t2;
    equation.constant = poses[0].rotation * change->first + poses[1].rotation * change->second - differ(lever);
    equation.visual_weight = 1 / squared(t1) + squared(1 / t1 + 1 / t2) + 1 / squared(t2);
    equation.inertial_variance = change->covariance.trace() / 3;
    equations.push_back(equation);
  }
  return equations;
}

struct Solution {
  double scale = 0;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();
  Eigen::Vector3d bias_change = Eigen::Vector3d::Zero();
  double scale_sigma = 0, bias_sigma = 0;  // of the scale as a share of it
  bool is_determined = false;
};

// The errors of keyframes' places [map units] as the equations' errors tell.
double visualSigma(const std::vector<Equation>& equations, const Solution& solution) {
  std::vector<double> ratios;
  for (const Equation& equation : equations) {
    const double error =
        equation.error(solution.scale, solution.gravity, solution.bias_change).squaredNorm() / three_normal_median;
    ratios.push_back(std::max(0.0, error - equation.inertial_variance) / equation.visual_weight);
  }
  return ratios.empty() ? 0 : std::sqrt(upperMedian(std::move(ratios)));
}

// Gravity's length is free: where to begin. A scale that wheels know is held.
Solution solveFreely(const std::vector<Equation>& equations, const WheelScale& wheels, double bias_prior) {
  using Vector7d = Eigen::Matrix<double, 7, 1>;
  using Matrix7 = Eigen::Matrix<double, 7, 7>;
  Matrix7 information = Matrix7::Zero();
  Vector7d right = Vector7d::Zero();
  for (const Equation& equation : equations) {
    Eigen::Matrix<double, 3, 7> by;
    by << equation.by_scale, -equation.by_gravity * Eigen::Matrix3d::Identity(), -equation.by_bias;
    information += by.transpose() * by / equation.visual_weight;
    right += by.transpose() * equation.constant / equation.visual_weight;
  }
  const double count = static_cast<double>(equations.size());
  information.diagonal().tail<3>().array() += 1e-4 * count / squared(bias_prior);
  if (wheels.is_known) {
    const double held = 1e6 * information.diagonal().maxCoeff();
    information(0, 0) += held;
    right(0) += held * wheels.metres_a_unit;
  }
  const Eigen::LDLT<Matrix7> factor(information);
  const Vector7d found = factor.solve(right);
  Solution solution;
  if (factor.info() != Eigen::Success || !found.allFinite()) return solution;
  solution.scale = found(0);
  solution.gravity = standard_gravity * found.segment<3>(1).normalized();
  solution.is_determined = true;
  return solution;
}

// Gravity as long as it is; Gauss and Newton's method on [scale; tilts of gravity [rad]; change of the bias].
Solution solve(const std::vector<Equation>& equations, const Solution& start, const InertialAlignment& so_far,
               const WheelScale& wheels, double bias_prior) {
  Solution solution = start;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const double visual_sigma = visualSigma(equations, solution);
    const Eigen::Matrix<double, 3, 2> tilts = standard_gravity * tangentsOf(solution.gravity.normalized());
    Matrix6d information = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    information.diagonal().tail<3>().setConstant(1 / squared(bias_prior));
    gradient.tail<3>() = solution.bias_change / squared(bias_prior);
    if (wheels.is_known) {
      const double sigma = held_scale_sigma * wheels.metres_a_unit;
      information(0, 0) = 1 / squared(sigma);
      gradient(0) = (solution.scale - wheels.metres_a_unit) / squared(sigma);
    } else if (so_far.is_known) {
      const double sigma = std::max(so_far.scale_sigma, least_scale_sigma) * so_far.metres_a_unit;
      information(0, 0) = 1 / squared(sigma);
      gradient(0) = (solution.scale - so_far.metres_a_unit) / squared(sigma);
    }
    for (const Equation& equation : equations) {
      const Eigen::Vector3d error = equation.error(solution.scale, solution.gravity, solution.bias_change);
      const double variance = squared(visual_sigma) * equation.visual_weight + equation.inertial_variance;
      const double norm = error.norm() / std::sqrt(variance);
      const double weight = (norm <= huber ? 1 : huber / norm) / variance;
      Matrix36d by;
      by << equation.by_scale, -equation.by_gravity * tilts, -equation.by_bias;
      information += weight * by.transpose() * by;
      gradient += weight * by.transpose() * error;
    }
    const Eigen::LLT<Matrix6d> factor(information);
    solution.is_determined = factor.info() == Eigen::Success;
    if (!solution.is_determined) return solution;
    const Vector6d step = -factor.solve(gradient);
    solution.scale += step(0);
    solution.gravity = standard_gravity * (solution.gravity + tilts * step.segment<2>(1)).normalized();
    solution.bias_change += step.tail<3>();
    const Matrix6d covariance = factor.solve(Matrix6d::Identity());
    solution.scale_sigma = honest_times * std::sqrt(covariance(0, 0)) / std::abs(solution.scale);
    solution.bias_sigma = honest_times * std::sqrt(covariance.diagonal().tail<3>().maxCoeff());
  }
  return solution;
}

InertialAlignment with(const Solution& solution, InertialAlignment alignment) {
  alignment.metres_a_unit = solution.scale;
  alignment.scale_sigma = solution.scale_sigma;
  alignment.gravity = solution.gravity;
  alignment.bias.force += solution.bias_change;
  alignment.force_bias_sigma = solution.bias_sigma;
  return alignment;
}

}  // namespace

InertialAlignmentEstimate estimateInertialAlignment(const InertialUnit& unit, const InertialAlignmentOptions& options,
                                                    const Map& map, int world, const InertialAlignment& so_far,
                                                    const WheelScale& wheels) {
  InertialAlignmentEstimate estimate{so_far, {}, ""};
  const std::vector<const Keyframe*> keyframes = latestKeyframes(map, world, options.most_keyframes);
  const double unknown_share = so_far.is_bias_known ? bias_change_prior : 1;
  const RateBias rates = estimateRateBias(keyframes, map, unit.imu_T_camera.rotation.conjugate(), so_far.bias,
                                          unknown_share * unknown_rate_bias);
  if (rates.contradicted > largest_turn_error * rates.turned && rates.contradicted > largest_turn_error_rad) {
    estimate.lacking = "inertia: the gyroscope contradicts the camera's turns; are its axes and imu_T_camera right?";
    return estimate;
  }
  InertialAlignment& found = estimate.alignment;
  found.bias.rate = rates.bias;
  found.rate_bias_sigma = rates.sigma;
  const std::vector<Equation> equations = equationsOf(keyframes, map, unit, found.bias);
  double seconds = 0;
  for (const Equation& equation : equations) seconds += equation.by_gravity;
  if (static_cast<int>(equations.size()) + 2 < options.fewest_keyframes || seconds < options.least_seconds) {
    estimate.lacking = "inertia: the map is too young for its scale";
    return estimate;
  }
  const double force_prior = unknown_share * unknown_force_bias;
  Solution solution{so_far.metres_a_unit, so_far.gravity, Eigen::Vector3d::Zero(), 0, 0, true};
  if (!so_far.is_known) solution = solveFreely(equations, wheels, force_prior);
  if (solution.is_determined) solution = solve(equations, solution, so_far, wheels, force_prior);
  if (!solution.is_determined || !(solution.scale > 0) || !(solution.scale_sigma < options.largest_scale_sigma)) {
    estimate.lacking = speed_changes_too_little;
    if (solution.is_determined && solution.scale > 0) estimate.rough = with(solution, found);
    return estimate;
  }
  found = with(solution, found);
  if (wheels.is_known) found.scale_sigma = wheels.sigma;
  found.is_known = found.is_bias_known = true;
  return estimate;
}

}  // namespace edgeslam
