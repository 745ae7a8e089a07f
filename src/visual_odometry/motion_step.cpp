#include "visual_odometry/motion_step.h"

#include <algorithm>

#include "geometry/rolling_shutter.h"
#include "geometry/uncertainty.h"

namespace edgeslam {
namespace {

double secondsBetween(std::int64_t from_ns, std::int64_t to_ns) { return 1e-9 * static_cast<double>(to_ns - from_ns); }

bool isKnown(const FrameResult& result) { return result.covariance.allFinite() && result.world_covariance.allFinite(); }

bool isUsable(const Pose& pose) { return isFinite(pose) && pose.rotation.norm() > 1e-3; }

bool tellsMotion(const FrameResult& result) { return result.has_motion && isUsable(result.previous_T_camera); }

// Share of a motion, at constant velocity in the camera's frame (Sola et al., A micro Lie theory, 2018, equation 172).
Pose shareOf(double share, const Pose& motion) {
  const Eigen::Vector3d turn = rotationLog(motion.rotation);
  const Eigen::Vector3d velocity = rightJacobian(-turn).inverse() * motion.translation;
  return {rotationExp(share * turn), share * (rightJacobian(-share * turn) * velocity)};
}

// What a covariance grew by, in the directions of its coordinates.
Matrix6d growth(const Matrix6d& before, const Matrix6d& now) {
  return Vector6d((now - before).diagonal().cwiseMax(0)).asDiagonal();
}

bool isMeasured(const FrameResult& result) {
  return isGoodPose(result.state) && result.has_pose && isUsable(result.world_T_camera) && !result.position_is_held;
}

Pose worldTCamera(const FrameResult& result) {
  return {result.world_T_camera.rotation.normalized(), result.world_T_camera.translation};
}

}  // namespace

std::optional<MotionStep> MotionSteps::next(const FrameResult& result) {
  map_is_new_ = map_is_new_ || result.state == TrackingState::initialising;
  const bool is_measured = isMeasured(result);
  if ((!last_ && !is_measured) || !isKnown(result)) return std::nullopt;

  MotionStep step;
  step.from_ns = last_ ? last_->time_ns : result.time_ns;
  step.to_ns = result.time_ns;
  step.is_measured = is_measured;
  step.is_broken = last_ && is_measured && isBroken(result);
  if (last_ && !step.is_broken) {
    const std::optional<Pose> motion = is_measured ? measuredMotion(result) : predictedMotion(result);
    if (!motion) return std::nullopt;
    step.before_T_now = *motion;
    if (is_measured && !last_->is_measured && !findError(result, step)) step.drift = last_->covariance;
    takeBack(step);
  }
  step.pose_covariance = result.covariance + pending_.covariance;
  if (is_measured) step.drift += driftSinceKnown(result, step);
  remember(result, step);
  return step;
}

bool MotionSteps::isBroken(const FrameResult& result) const {
  return map_is_new_ || result.world != known_.world || secondsBetween(seen_ns_, result.time_ns) > longest_bridged_s ||
         !tellsMotion(result) || result.previous_time_ns >= result.time_ns;
}

// After frames without a measured pose it goes on at the speed that was measured across them.
std::optional<Pose> MotionSteps::measuredMotion(const FrameResult& result) const {
  Pose motion = result.previous_T_camera;
  if (result.previous_time_ns != last_->time_ns) {
    const double share =
        secondsBetween(last_->time_ns, result.time_ns) / secondsBetween(result.previous_time_ns, result.time_ns);
    motion = shareOf(share, motion);
  }
  if (result.previous_position_was_held) motion.translation.setZero();
  return motion;
}

std::optional<Pose> MotionSteps::predictedMotion(const FrameResult& result) const {
  if (!tellsMotion(result) || map_is_new_ || secondsBetween(seen_ns_, result.time_ns) > longest_bridged_s) {
    return std::nullopt;
  }
  if (result.previous_time_ns == last_->time_ns) return result.previous_T_camera;
  if (result.previous_time_ns != last_->previous_time_ns) return std::nullopt;
  return last_->previous_T_camera.inverse() * result.previous_T_camera;  // both predicted from the same frame
}

// The map tells how the camera moved since all was known last. False where it is no longer the same map.
bool MotionSteps::findError(const FrameResult& result, const MotionStep& step) {
  if (result.map_corrections != known_.map_corrections) return false;
  const Pose known_T_truth = known_.error * known_.world_T_camera.inverse() * worldTCamera(result);
  const Pose error = (known_.known_T_given * step.before_T_now).inverse() * known_T_truth;
  pending_ = {step.before_T_now * error * step.before_T_now.inverse(), last_->covariance, taken_back_over_s};
  return true;
}

void MotionSteps::takeBack(MotionStep& step) {
  if (!(pending_.seconds > 0)) return;
  const Pose error = step.before_T_now.inverse() * pending_.error * step.before_T_now;
  const double share = std::min(1.0, secondsBetween(step.from_ns, step.to_ns) / pending_.seconds);
  step.taken_back = shareOf(share, error);
  pending_ = {step.taken_back.inverse() * error, (1 - share) * (1 - share) * pending_.covariance,
              (1 - share) * pending_.seconds};
}

Matrix6d MotionSteps::driftSinceKnown(const FrameResult& result, const MotionStep& step) const {
  if (!last_ || step.is_broken) return result.covariance;
  const Pose known_T_now = known_.known_T_given * step.before_T_now * step.taken_back;
  return growth(carriedCovariance(known_.world_covariance, known_T_now), result.world_covariance);
}

void MotionSteps::remember(const FrameResult& result, const MotionStep& step) {
  if (step.is_broken) pending_ = Pending();
  known_.known_T_given = known_.known_T_given * step.before_T_now * step.taken_back;
  if (step.is_measured) {
    known_ = {result.world, result.map_corrections, worldTCamera(result), result.world_covariance,
              Pose(),       pending_.error};
    map_is_new_ = false;
  }
  if (isGoodPose(result.state)) seen_ns_ = result.time_ns;
  const bool has_motion = tellsMotion(result);
  last_ = Given{result.time_ns, has_motion ? result.previous_time_ns : -1,
                has_motion ? result.previous_T_camera : Pose(), result.covariance, step.is_measured};
}

}  // namespace edgeslam
