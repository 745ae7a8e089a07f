#include "mapping/inertial_terms.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace edgeslam {
namespace {

// What units err by beyond their noise and bias: the scale of their axes, and how they are mounted.
constexpr double least_turn_sigma = 5e-4;   // [rad]
constexpr double least_speed_sigma = 2e-3;  // [m/s]

double squared(double value) { return value * value; }

// W with W^T W the inverse of a covariance.
Eigen::Matrix3d whiteningOf(const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d lower = covariance.llt().matrixL();
  return lower.triangularView<Eigen::Lower>().solve(Eigen::Matrix3d::Identity());
}

BundleTurn turnOf(const InertialLink& link, const InertialAlignment& alignment, const Eigen::Quaterniond& camera_R_imu,
                  int first, int second) {
  const PreintegratedMotion motion = withBias(link.motion, alignment.bias);
  Eigen::Matrix3d covariance = motion.covariance.topLeftCorner<3, 3>();
  covariance.diagonal().array() += squared(alignment.rate_bias_sigma * motion.seconds) + squared(least_turn_sigma);
  const Eigen::Matrix3d turn = camera_R_imu.toRotationMatrix();
  return {first, second, (camera_R_imu * motion.rotation * camera_R_imu.conjugate()).normalized(),
          whiteningOf(turn * covariance * turn.transpose())};
}

bool touches(const std::vector<KeyframeId>& sorted, KeyframeId keyframe) {
  return std::binary_search(sorted.begin(), sorted.end(), keyframe);
}

}  // namespace

std::optional<SpeedChange> speedChangeTo(const Map& map, const Keyframe& last, const InertialBias& bias,
                                         const Eigen::Quaterniond& camera_R_imu) {
  const Keyframe* middle = map.keyframes.find(last.inertia.from);
  const Keyframe* first = middle ? map.keyframes.find(middle->inertia.from) : nullptr;
  if (!first) return std::nullopt;
  const PreintegratedMotion one = withBias(middle->inertia.motion, bias);
  const PreintegratedMotion two = withBias(last.inertia.motion, bias);
  SpeedChange change;
  change.keyframes = {first->id, middle->id, last.id};
  change.seconds = {one.seconds, two.seconds};
  change.first = camera_R_imu * (one.velocity - one.position / one.seconds);
  change.second = camera_R_imu * (two.position / two.seconds);
  Eigen::Matrix<double, 3, 9> by_first = Eigen::Matrix<double, 3, 9>::Zero();
  by_first.block<3, 3>(0, 3).setIdentity();
  by_first.block<3, 3>(0, 6) = -Eigen::Matrix3d::Identity() / one.seconds;
  const Eigen::Matrix3d first_turn = camera_R_imu.toRotationMatrix();
  const Eigen::Matrix3d second_turn =
      (camera_R_imu * one.rotation).toRotationMatrix();  // of the middle one's unit, in the first one's camera frame
  change.covariance =
      first_turn * by_first * one.covariance * by_first.transpose() * first_turn.transpose() +
      second_turn * two.covariance.bottomRightCorner<3, 3>() * second_turn.transpose() / squared(two.seconds);
  return change;
}

void addInertialTerms(const InertialUnit& unit, const InertialAlignment& alignment, const Map& map,
                      const std::vector<KeyframeId>& free, const std::function<int(KeyframeId)>& camera_of,
                      BundleProblem& problem) {
  const Eigen::Quaterniond camera_R_imu = unit.imu_T_camera.rotation.conjugate();
  problem.inertia = {alignment.metres_a_unit, alignment.gravity, unit.imu_T_camera.inverse().translation};
  for (const Keyframe& keyframe : map.keyframes) {
    const Keyframe* before = map.keyframes.find(keyframe.inertia.from);
    if (!before) continue;
    const bool is_of_free = touches(free, before->id) || touches(free, keyframe.id);
    if (is_of_free) {
      problem.turns.push_back(
          turnOf(keyframe.inertia, alignment, camera_R_imu, camera_of(before->id), camera_of(keyframe.id)));
    }
    const Keyframe* first = map.keyframes.find(before->inertia.from);
    if (!alignment.is_known || !first || !(is_of_free || touches(free, first->id))) continue;
    const std::optional<SpeedChange> change = speedChangeTo(map, keyframe, alignment.bias, camera_R_imu);
    Eigen::Matrix3d covariance = change->covariance;
    covariance.diagonal().array() +=
        squared(0.5 * (change->seconds[0] + change->seconds[1])) * squared(alignment.force_bias_sigma) +
        squared(least_speed_sigma);
    problem.speed_changes.push_back({{camera_of(first->id), camera_of(before->id), camera_of(keyframe.id)},
                                     change->seconds,
                                     change->first,
                                     change->second,
                                     whiteningOf(covariance)});
  }
}

}  // namespace edgeslam
