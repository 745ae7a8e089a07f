#include "mapping/wheel_terms.h"

#include <algorithm>
#include <utility>

#include "geometry/uncertainty.h"

namespace edgeslam {
namespace {

// Of the whitened difference's length, and of the way alone: a keyframe that was placed badly is off by less than
// wheels that slip.
constexpr double slipped = 12;
constexpr double least_slip = 0.05;  // [map units]: the scene of the map's start is one away
// Hundreds of points, whose errors hang together, claim to know the cameras so many times better than they do: what the
// wheels say is told against them by as much.
constexpr double claim_of_points = 8;
constexpr double huber_times = 12;  // of the whitened error, then: from three standard deviations on it counts linearly

Eigen::Matrix3d turnWhitening(const WheelMotion& motion) {
  return whiteningOf(motion.covariance.bottomRightCorner<3, 3>());
}

// Of the way in the first one's frame.
Eigen::Matrix3d wayWhitening(const WheelMotion& motion) {
  const Eigen::Matrix3d turn = motion.first_T_second.rotation.toRotationMatrix();
  return whiteningOf(turn * motion.covariance.topLeftCorner<3, 3>() * turn.transpose());
}

// Of turns by the wheels and by the gyroscope: of the wheels' standard deviations, and of the turn.
constexpr double contradicting_turn = 5, contradicting_turn_share = 0.1;

enum class TurnBeside { none, agrees, contradicts };

// What the gyroscope says of the wheels' turn to a keyframe.
TurnBeside turnBeside(const std::optional<GyroscopeBeside>& gyroscope, const WheelMotion& motion, const Keyframe& first,
                      const Keyframe& keyframe) {
  if (!gyroscope || keyframe.inertia.from != first.id) return TurnBeside::none;
  const Eigen::Quaterniond& camera_R_imu = gyroscope->camera_R_imu;
  const Eigen::Quaterniond turn =
      (camera_R_imu * withBias(keyframe.inertia.motion, gyroscope->bias).rotation * camera_R_imu.conjugate())
          .normalized();
  const Eigen::Vector3d error = rotationLog((motion.first_T_second.rotation.conjugate() * turn).normalized());
  const double allowed =
      contradicting_turn + contradicting_turn_share * (turnWhitening(motion) * rotationLog(turn)).norm();
  return (turnWhitening(motion) * error).norm() <= allowed ? TurnBeside::agrees : TurnBeside::contradicts;
}

}  // namespace

std::optional<WheelMotion> motionToNext(const WheelOptions& options, const WheelScale& scale, const Keyframe& keyframe,
                                        const Keyframe& next) {
  const std::optional<WheelMotion> motion = wheelMotion(options, keyframe.wheels, next.wheels);
  if (!motion) return std::nullopt;
  const Pose moved = keyframe.world_T_camera.inverse() * next.world_T_camera;
  const Eigen::Quaterniond turn_error = motion->first_T_second.rotation.conjugate() * moved.rotation;
  if (!((turnWhitening(*motion) * rotationLog(turn_error.normalized())).norm() <= slipped)) return std::nullopt;
  if (!scale.is_known) return motion;
  const Eigen::Vector3d way_error = scale.metres_a_unit * moved.translation - motion->first_T_second.translation;
  const bool is_far = way_error.norm() > least_slip * scale.metres_a_unit;
  return is_far && (wayWhitening(*motion) * way_error).norm() > slipped ? std::nullopt : motion;
}

void addWheelTerms(const WheelOptions& options, const WheelScale& scale,
                   const std::optional<GyroscopeBeside>& gyroscope, const Map& map, const std::vector<KeyframeId>& free,
                   const std::function<int(KeyframeId)>& camera_of, BundleProblem& problem) {
  const auto isFree = [&](const Keyframe& keyframe) {
    return std::binary_search(free.begin(), free.end(), keyframe.id);
  };
  const int world = map.keyframes[free.front()].world;
  const Keyframe* before = nullptr;
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.world != world) continue;
    const Keyframe* first = std::exchange(before, &keyframe);
    if (!first || !(isFree(*first) || isFree(keyframe))) continue;
    const std::optional<WheelMotion> motion = motionToNext(options, scale, *first, keyframe);
    const TurnBeside beside = motion ? turnBeside(gyroscope, *motion, *first, keyframe) : TurnBeside::contradicts;
    if (beside == TurnBeside::contradicts) continue;
    const double claim_of_turn = beside == TurnBeside::agrees ? 1 : claim_of_points;
    const int first_camera = camera_of(first->id), second_camera = camera_of(keyframe.id);
    problem.turns.push_back({first_camera, second_camera, motion->first_T_second.rotation,
                             claim_of_turn * turnWhitening(*motion), huber_times});
    if (!scale.is_known) continue;
    problem.ways.push_back({first_camera, second_camera, motion->first_T_second.translation,
                            claim_of_points * wayWhitening(*motion), huber_times, scale.metres_a_unit});
  }
}

}  // namespace edgeslam
