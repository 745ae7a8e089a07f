#include "visual_odometry/motion_step.h"

#include <algorithm>

#include "geometry/rolling_shutter.h"
#include "geometry/uncertainty.h"

namespace edgeslam {
namespace {

double secondsBetween(std::int64_t from_ns, std::int64_t to_ns) { return 1e-9 * static_cast<double>(to_ns - from_ns); }

bool isFinite(const Pose& pose) {
  return pose.translation.allFinite() && pose.rotation.coeffs().allFinite() && pose.rotation.norm() > 1e-3;
}

bool tellsMotion(const FrameResult& result) {
  return result.has_motion && isFinite(result.previous_T_camera) && result.covariance.allFinite();
}

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

}  // namespace

std::optional<MotionStep> MotionSteps::next(const FrameResult& result) {
  const bool is_measured = isGoodPose(result.state) && result.has_pose && isFinite(result.world_T_camera) &&
                           result.covariance.allFinite() && !result.position_is_held;
  const bool is_held = isGoodPose(result.state) && result.position_is_held;
  map_is_new_ = map_is_new_ || result.state == TrackingState::initialising;
  if (!last_ && !is_measured) return std::nullopt;

  std::optional<MotionStep> step = MotionStep();
  if (!last_) {
    step->from_ns = result.time_ns;
  } else if (is_measured && isWithoutBridge(result)) {
    step->from_ns = last_->time_ns;
    step->is_broken = true;
  } else {
    step = is_measured ? measured(result) : predicted(result);
  }
  if (!step) return std::nullopt;
  step->to_ns = result.time_ns;
  step->is_measured = is_measured;
  if (is_measured || is_held) known_ns_ = result.time_ns;
  if (is_measured) {
    world_ = result.world;
    map_is_new_ = false;
  }
  const bool has_motion = tellsMotion(result);
  last_ = Given{result.time_ns, has_motion ? result.previous_time_ns : -1,
                has_motion ? result.previous_T_camera : Pose(), result.covariance, is_measured};
  return step;
}

bool MotionSteps::isWithoutBridge(const FrameResult& result) const {
  return map_is_new_ || result.world != world_ || secondsBetween(known_ns_, result.time_ns) > longest_bridged_s ||
         !tellsMotion(result) || result.previous_time_ns >= result.time_ns;
}

// After frames without a measured pose the motion goes on at the speed that was measured across them: what was
// predicted in between is not taken back, which would be a jump.
std::optional<MotionStep> MotionSteps::measured(const FrameResult& result) const {
  MotionStep step;
  step.from_ns = last_->time_ns;
  step.before_T_now = result.previous_T_camera;
  if (result.previous_time_ns != last_->time_ns) {
    const double share =
        secondsBetween(last_->time_ns, result.time_ns) / secondsBetween(result.previous_time_ns, result.time_ns);
    step.before_T_now = shareOf(share, result.previous_T_camera);
  }
  if (result.previous_position_was_held) step.before_T_now.translation.setZero();
  step.covariance = result.covariance +
                    carriedCovariance(last_->is_measured ? last_->covariance : result.covariance, step.before_T_now);
  return step;
}

std::optional<MotionStep> MotionSteps::predicted(const FrameResult& result) const {
  if (!tellsMotion(result) || map_is_new_ || secondsBetween(known_ns_, result.time_ns) > longest_bridged_s) {
    return std::nullopt;
  }
  MotionStep step;
  step.from_ns = last_->time_ns;
  step.before_T_now = result.previous_T_camera;
  if (result.previous_time_ns == last_->previous_time_ns) {  // predicted from the same frame as the one before
    step.before_T_now = last_->previous_T_camera.inverse() * result.previous_T_camera;
  } else if (result.previous_time_ns != last_->time_ns) {
    return std::nullopt;
  }
  step.covariance = growth(last_->covariance, result.covariance);
  return step;
}

}  // namespace edgeslam
