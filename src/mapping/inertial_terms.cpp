#include "mapping/inertial_terms.h"

#include <algorithm>

#include "geometry/squared.h"
#include "geometry/uncertainty.h"

namespace edgeslam {
namespace {

// What units err by beyond their noise and bias: the scale of their axes, and how they are mounted.
constexpr double least_turn_sigma = 5e-4;   // [rad]
constexpr double least_speed_sigma = 2e-3;  // [m/s]
// Standard deviations of the biases, where they are adjusted.
constexpr double free_rate_bias_sigma = 0.02;  // [rad/s]
constexpr double free_force_bias_sigma = 0.3;  // [m/s^2]

BundleTurn turnOf(const InertialLink& link, const InertialBias& bias, double rate_bias_sigma,
                  const Eigen::Quaterniond& camera_R_imu, int first, int second) {
  const PreintegratedMotion motion = withBias(link.motion, bias);
  Eigen::Matrix3d covariance = motion.covariance.topLeftCorner<3, 3>();
  covariance.diagonal().array() += squared(rate_bias_sigma * motion.seconds) + squared(least_turn_sigma);
  const Eigen::Matrix3d turn = camera_R_imu.toRotationMatrix();
  return {first,
          second,
          (camera_R_imu * motion.rotation * camera_R_imu.conjugate()).normalized(),
          whiteningOf(turn * covariance * turn.transpose()),
          inertial_huber_times,
          turn * motion.by_bias.topLeftCorner<3, 3>()};
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
  change.first_by_bias = first_turn * (one.by_bias.middleRows<3>(3) - one.by_bias.bottomRows<3>() / one.seconds);
  change.second_by_bias = first_turn * two.by_bias.bottomRows<3>() / two.seconds;
  change.covariance =
      first_turn * by_first * one.covariance * by_first.transpose() * first_turn.transpose() +
      second_turn * two.covariance.bottomRightCorner<3, 3>() * second_turn.transpose() / squared(two.seconds);
  return change;
}

void addInertialTerms(const InertialUnit& unit, const InertialAlignment& alignment, bool is_free, const Map& map,
                      const std::vector<KeyframeId>& free, const std::function<int(KeyframeId)>& camera_of,
                      BundleProblem& problem) {
  const Eigen::Quaterniond camera_R_imu = unit.imu_T_camera.rotation.conjugate();
  problem.inertia.metres_a_unit = alignment.metres_a_unit;
  problem.inertia.gravity = alignment.gravity;
  problem.inertia.camera_t_imu = unit.imu_T_camera.inverse().translation;
  problem.inertia.is_free = is_free;
  problem.inertia.rate_bias_sigma = free_rate_bias_sigma;
  problem.inertia.force_bias_sigma = free_force_bias_sigma;
  // What is adjusted is no noise, and begins where it was found; how large it can be says the unit, not the map.
  const InertialBias bias = is_free ? InertialBias() : alignment.bias;
  if (is_free) problem.inertia.bias_change << alignment.bias.rate, alignment.bias.force;
  const double rate_bias_sigma = is_free ? 0 : alignment.rate_bias_sigma;
  const double force_bias_sigma = is_free ? 0 : alignment.force_bias_sigma;
  for (const Keyframe& keyframe : map.keyframes) {
    const Keyframe* before = map.keyframes.find(keyframe.inertia.from);
    if (!before) continue;
    const bool is_of_free = touches(free, before->id) || touches(free, keyframe.id);
    if (is_of_free) {
      problem.turns.push_back(
          turnOf(keyframe.inertia, bias, rate_bias_sigma, camera_R_imu, camera_of(before->id), camera_of(keyframe.id)));
    }
    const Keyframe* first = map.keyframes.find(before->inertia.from);
    if (!(alignment.is_known || is_free) || !first || !(is_of_free || touches(free, first->id))) continue;
    const std::optional<SpeedChange> change = speedChangeTo(map, keyframe, bias, camera_R_imu);
    Eigen::Matrix3d covariance = change->covariance;
    covariance.diagonal().array() +=
        squared(0.5 * (change->seconds[0] + change->seconds[1])) * squared(force_bias_sigma) +
        squared(least_speed_sigma);
    problem.speed_changes.push_back({{camera_of(first->id), camera_of(before->id), camera_of(keyframe.id)},
                                     change->seconds,
                                     change->first,
                                     change->second,
                                     whiteningOf(covariance),
                                     change->first_by_bias,
                                     change->second_by_bias});
  }
}

}  // namespace edgeslam
