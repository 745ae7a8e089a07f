#include "calibration/force_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

#include "geometry/tangents.h"
#include "inertia/inertial_history.h"
#include "inertia/pose_errors.h"
#include "samples/sample_feed.h"

namespace edgeslam {
namespace {

constexpr double step_s = 0.3;  // between three poses
constexpr std::size_t fewest_changes = 100;
constexpr double place_prior_m = 0.1;  // a unit is no farther from where it is said to be
constexpr double bias_prior = 0.5;     // [m/s^2]
constexpr int iterations = 12;
constexpr double largest_scale_sigma = 0.05, largest_bias_sigma = 0.05, largest_place_sigma_m = 0.01;

constexpr int force_unknowns = 9;  // scale; tilts of gravity (2) [rad]; bias (3); camera_t_imu (3)
using Vector9 = Eigen::Matrix<double, force_unknowns, 1>;
using Matrix9 = Eigen::Matrix<double, force_unknowns, force_unknowns>;
using Matrix39 = Eigen::Matrix<double, 3, force_unknowns>;

// How the mean speed changes between the two halves of three poses, which knows no speed: as seen [map units/s], and as
// felt [m/s] without gravity, bias and lever arm, each of which adds its share.
struct SpeedChange {
  std::int64_t from_ns = 0;
  Eigen::Vector3d seen, felt;
  Eigen::Matrix3d by_lever, by_bias;
  double by_gravity = 0;
};

struct Unknowns {
  double scale = 1;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  // the map's frame [m/s^2]
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d camera_t_imu = Eigen::Vector3d::Zero();
};

Eigen::Vector3d errorOf(const SpeedChange& change, const Unknowns& x) {
  return x.scale * change.seen + change.by_lever * x.camera_t_imu - change.by_gravity * x.gravity -
         change.by_bias * x.bias - change.felt;
}

Matrix39 derivativeOf(const SpeedChange& change, const Unknowns& x) {
  Matrix39 by;
  by << change.seen, -change.by_gravity * standard_gravity * tangentsOf(x.gravity.normalized()), -change.by_bias,
      change.by_lever;
  return by;
}

Unknowns changed(const Unknowns& x, const Vector9& step) {
  Unknowns now = x;
  now.scale += step(0);
  const Eigen::Vector3d down = x.gravity.normalized();
  now.gravity = standard_gravity * (down + tangentsOf(down) * step.segment<2>(1)).normalized();
  now.bias += step.segment<3>(3);
  now.camera_t_imu += step.tail<3>();
  return now;
}

std::vector<PosedCamera> ofMainWorld(const std::vector<PosedCamera>& poses) {
  std::map<int, std::size_t> counts;
  for (const PosedCamera& posed : poses) ++counts[posed.world];
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  std::vector<PosedCamera> main;
  std::copy_if(poses.begin(), poses.end(), std::back_inserter(main),
               [&](const PosedCamera& posed) { return posed.world == most->first; });
  return main;
}

// The first pose at least `step_s` after another, and at most half as long again; none: the end.
std::size_t oneStepAfter(const std::vector<PosedCamera>& poses, std::size_t from) {
  const std::int64_t step_ns = std::llround(step_s * 1e9), from_ns = poses[from].time_ns;
  std::size_t to = from;
  while (to < poses.size() && poses[to].time_ns < from_ns + step_ns) ++to;
  return to < poses.size() && poses[to].time_ns <= from_ns + step_ns + step_ns / 2 ? to : poses.size();
}

SpeedChange speedChange(const std::array<Pose, 3>& poses, const PreintegratedMotion& one,
                        const PreintegratedMotion& two, const Eigen::Quaterniond& camera_R_imu) {
  const double t1 = one.seconds, t2 = two.seconds;
  const Eigen::Matrix3d r0 = (poses[0].rotation * camera_R_imu).toRotationMatrix();
  const Eigen::Matrix3d r1 = (poses[1].rotation * camera_R_imu).toRotationMatrix();
  const auto rotation = [&](std::size_t k) -> Eigen::Matrix3d { return poses[k].rotation.toRotationMatrix(); };
  SpeedChange change;
  change.seen = (poses[2].translation - poses[1].translation) / t2 - (poses[1].translation - poses[0].translation) / t1;
  change.by_lever = (rotation(2) - rotation(1)) / t2 - (rotation(1) - rotation(0)) / t1;
  change.felt = r0 * (one.velocity - one.position / t1) + r1 * two.position / t2;
  change.by_bias = r0 * (one.by_bias.block<3, 3>(3, 3) - one.by_bias.block<3, 3>(6, 3) / t1) +
                   r1 * two.by_bias.block<3, 3>(6, 3) / t2;
  change.by_gravity = 0.5 * (t1 + t2);
  return change;
}

std::vector<SpeedChange> speedChanges(const std::vector<PosedCamera>& poses, const std::vector<InertialSample>& samples,
                                      const InertialUnit& unit, const Eigen::Vector3d& rate_bias) {
  const Eigen::Quaterniond camera_R_imu = unit.imu_T_camera.rotation.conjugate();
  const InertialBias bias{rate_bias, Eigen::Vector3d::Zero()};
  InertialHistory history(unit);
  SampleFeed feed(samples, unit.offset_ns);
  std::vector<SpeedChange> changes;
  for (std::size_t first = 0; first < poses.size(); ++first) {
    const std::size_t second = oneStepAfter(poses, first);
    const std::size_t third = second < poses.size() ? oneStepAfter(poses, second) : second;
    if (third == poses.size()) continue;
    feed.giveUntil(poses[third].time_ns, [&](const InertialSample& sample) { history.add(sample); });
    const auto one = history.between(poses[first].time_ns, poses[second].time_ns, bias);
    const auto two = history.between(poses[second].time_ns, poses[third].time_ns, bias);
    if (!one || !two) continue;
    changes.push_back(
        speedChange({poses[first].world_T_camera, poses[second].world_T_camera, poses[third].world_T_camera}, *one,
                    *two, camera_R_imu));
    changes.back().from_ns = poses[first].time_ns;
  }
  return changes;
}

// Gravity's length is free, and lever arm and bias are none: where to begin. None where it is far from gravity's.
std::optional<Unknowns> startOf(const std::vector<SpeedChange>& changes, const Eigen::Vector3d& camera_t_imu) {
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (const SpeedChange& change : changes) {
    Eigen::Matrix<double, 3, 4> by;
    by << change.seen, -change.by_gravity * Eigen::Matrix3d::Identity();
    information += by.transpose() * by;
    right += by.transpose() * (change.felt - change.by_lever * camera_t_imu);
  }
  const Eigen::LDLT<Eigen::Matrix4d> factor(information);
  const Eigen::Vector4d found = factor.solve(right);
  if (factor.info() != Eigen::Success || !found.allFinite()) return std::nullopt;
  if (std::abs(found.tail<3>().norm() - standard_gravity) > 0.2 * standard_gravity) return std::nullopt;
  Unknowns start;
  start.scale = found(0);
  start.gravity = standard_gravity * found.tail<3>().normalized();
  start.camera_t_imu = camera_t_imu;
  return start;
}

// Of the errors.
struct Weights {
  std::vector<double> of;
  double variance = 0;  // of an error, each axis [m^2/s^2]
};

Weights weightsOf(const std::vector<SpeedChange>& changes, const Unknowns& x) {
  std::vector<double> lengths;
  lengths.reserve(changes.size());
  for (const SpeedChange& change : changes) lengths.push_back(errorOf(change, x).norm());
  Weights weights;
  weights.of = cauchyWeights(lengths);
  double squares = 0, sum = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    squares += weights.of[i] * lengths[i] * lengths[i];
    sum += weights.of[i];
  }
  weights.variance = std::max(1e-12, squares / (3 * sum));
  return weights;
}

Vector9 priorInformation() {
  Vector9 information = Vector9::Zero();
  information.segment<3>(3).setConstant(1 / (bias_prior * bias_prior));
  information.tail<3>().setConstant(1 / (place_prior_m * place_prior_m));
  return information;
}

struct ForceEquations {
  Matrix9 information = Matrix9::Zero();
  Vector9 gradient = Vector9::Zero();
  Matrix9 scatter = Matrix9::Zero();  // of what parts of the recording add to the gradient
};

ForceEquations forceEquations(const std::vector<SpeedChange>& changes, const Unknowns& x,
                              const Eigen::Vector3d& camera_t_imu) {
  const Weights weights = weightsOf(changes, x);
  const std::int64_t begin_ns = changes.front().from_ns;
  const std::int64_t part_ns = partLength(begin_ns, changes.back().from_ns);
  ForceEquations equations;
  std::map<std::int64_t, Vector9> parts;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const Matrix39 by = derivativeOf(changes[i], x);
    const double weight = weights.of[i] / weights.variance;
    const Vector9 gradient = weight * by.transpose() * errorOf(changes[i], x);
    equations.information += weight * by.transpose() * by;
    equations.gradient += gradient;
    parts.try_emplace((changes[i].from_ns - begin_ns) / part_ns, Vector9::Zero()).first->second += gradient;
  }
  for (const auto& [number, gradient] : parts) equations.scatter += gradient * gradient.transpose();
  const double count = static_cast<double>(parts.size());
  equations.scatter *= unseen_times * unseen_times * count / std::max(1.0, count - force_unknowns);
  const Vector9 prior = priorInformation();
  equations.information.diagonal() += prior;
  equations.scatter.diagonal() += prior;
  equations.gradient.segment<3>(3) += prior.segment<3>(3).cwiseProduct(x.bias);
  equations.gradient.tail<3>() += prior.tail<3>().cwiseProduct(x.camera_t_imu - camera_t_imu);
  return equations;
}

// By which a wrong rotation is taken for a bias: gravity, which is nearly all that is felt, is turned by it.
Eigen::Matrix3d biasByRotation(const std::vector<InertialSample>& samples, const Eigen::Quaterniond& imu_R_camera) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const InertialSample& sample : samples) mean += sample.force / static_cast<double>(samples.size());
  return imu_R_camera.toRotationMatrix() * skew(imu_R_camera.conjugate() * mean);
}

ForceFit fitOf(const Unknowns& x, const Matrix9& covariance, const Eigen::Quaterniond& imu_R_camera) {
  const Eigen::Matrix3d turned = imu_R_camera.toRotationMatrix();
  const Eigen::Matrix3d place = turned * covariance.bottomRightCorner<3, 3>() * turned.transpose();
  ForceFit fit;
  fit.bias = x.bias;
  fit.bias_sigma = covariance.diagonal().segment<3>(3).cwiseSqrt();
  fit.imu_t_camera = -(imu_R_camera * x.camera_t_imu);
  fit.imu_t_camera_sigma = place.diagonal().cwiseSqrt();
  fit.metres_a_unit = x.scale;
  fit.scale_sigma = std::sqrt(covariance(0, 0)) / std::abs(x.scale);
  const bool tells_scale = x.scale > 0 && fit.scale_sigma < largest_scale_sigma;
  fit.tells_bias = x.scale > 0 && fit.bias_sigma.maxCoeff() < largest_bias_sigma;
  fit.tells_place = tells_scale && fit.imu_t_camera_sigma.maxCoeff() < largest_place_sigma_m;
  return fit;
}

}  // namespace

std::optional<ForceFit> fitForces(const std::vector<PosedCamera>& poses, const std::vector<InertialSample>& samples,
                                  const InertialUnit& unit, const Eigen::Matrix3d& rotation_covariance,
                                  const Eigen::Vector3d& rate_bias) {
  if (poses.empty()) return std::nullopt;
  const std::vector<SpeedChange> changes = speedChanges(ofMainWorld(poses), samples, unit, rate_bias);
  if (changes.size() < fewest_changes) return std::nullopt;
  const Eigen::Vector3d camera_t_imu = unit.imu_T_camera.inverse().translation;
  const std::optional<Unknowns> start = startOf(changes, camera_t_imu);
  if (!start) return std::nullopt;
  Unknowns x = *start;
  Matrix9 covariance = Matrix9::Zero();
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const ForceEquations equations = forceEquations(changes, x, camera_t_imu);
    const Eigen::LDLT<Matrix9> factor(equations.information);
    if (factor.info() != Eigen::Success) return std::nullopt;
    const Matrix9 inverse = factor.solve(Matrix9::Identity());
    if (!inverse.allFinite()) return std::nullopt;
    covariance = inverse * equations.scatter * inverse;
    x = changed(x, -inverse * equations.gradient);
  }
  const Eigen::Matrix3d by_rotation = biasByRotation(samples, unit.imu_T_camera.rotation);
  covariance.block<3, 3>(3, 3) += by_rotation * rotation_covariance * by_rotation.transpose();
  return fitOf(x, covariance, unit.imu_T_camera.rotation);
}

}  // namespace edgeslam
