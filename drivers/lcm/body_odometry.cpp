#include "drivers/lcm/body_odometry.h"

#include "drivers/lcm/message_fields.h"
#include "wheels/utime.h"

namespace edgeslam {
namespace {

constexpr double least_change = 1e-6;  // [m or map units, rad]

bool differ(const Pose& a, const Pose& b) {
  return (a.translation - b.translation).norm() > least_change || rotationAngle(a.rotation, b.rotation) > least_change;
}

pose_t odometryMessage(const OdometryFrame& frame, const MotionStep& step) {
  pose_t message{};
  message.utime = utimeOf(step.to_ns);
  put(frame.odom_T_camera.translation, message.pos);
  put(frame.odom_T_camera.rotation, message.orientation);
  const double seconds = 1e-9 * static_cast<double>(step.to_ns - step.from_ns);
  if (step.is_broken || !(seconds > 0)) return message;
  const Pose& moved = step.before_T_now;
  put(Eigen::Vector3d(moved.rotation.conjugate() * moved.translation / seconds), message.vel);
  put(Eigen::Vector3d(rotationLog(moved.rotation) / seconds), message.rotation_rate);
  return message;
}

}  // namespace

std::optional<OdometryMessages> BodyOdometry::next(const FrameResult& result, const RobotSetup& robot) {
  std::optional<MotionStep> step = steps_.next(result);
  if (!step) return std::nullopt;
  const Circumstances now{hasUsablePose(result) ? worldOf(result) : (before_ ? before_->world : 0),
                          result.map_corrections,
                          robot.scale.metres_per_unit,
                          robot.scale.kind != ScaleKind::unknown,
                          robot.down,
                          step->is_measured,
                          differ(step->taken_back, Pose())};
  if (before_ && before_->is_scale_known != now.is_scale_known) {
    step->is_broken = true;
    step->before_T_now = step->taken_back = Pose();
  }
  const MotionStep of_body = bodyStep(*step, robot);
  frame_ = moved(frame_, of_body);
  correct(result, robot, now);
  before_ = now;

  OdometryMessages messages{odometryMessage(frame_, of_body), {}};
  correction_t& correction = messages.correction;
  correction.utime = messages.odometry.utime;
  correction.world = now.world;
  put(local_T_odom_.translation, correction.translation);
  put(local_T_odom_.rotation, correction.rotation);
  correction.change_utime = change_utime_;
  correction.change = change_;
  correction.reset_count = frame_.resets;
  correction.is_measured = step->is_measured;
  put(frame_.covariance, correction.covariance);
  return messages;
}

// A frame without a pose in `local` leaves the correction as it was.
void BodyOdometry::correct(const FrameResult& result, const RobotSetup& robot, const Circumstances& now) {
  if (!hasUsablePose(result)) return;
  const Pose world_T_camera{result.world_T_camera.rotation.normalized(), result.world_T_camera.translation};
  const Pose local_T_odom = bodyPose(world_T_camera, robot) * frame_.odom_T_camera.inverse();
  if (!before_ || differ(local_T_odom, local_T_odom_)) {
    change_utime_ = utimeOf(result.time_ns);
    change_ = reasonOf(result, now);
  }
  local_T_odom_ = local_T_odom;
}

std::int8_t BodyOdometry::reasonOf(const FrameResult& result, const Circumstances& now) const {
  if (!before_) return correction_t::START;
  if (now.world != before_->world) return correction_t::ANOTHER_WORLD;
  if (now.metres_per_unit != before_->metres_per_unit || now.is_scale_known != before_->is_scale_known ||
      now.down != before_->down) {
    return correction_t::SCALE;
  }
  if (result.state == TrackingState::recovered || result.state == TrackingState::relocalised) {
    return correction_t::FOUND_AGAIN;
  }
  if (now.map_corrections != before_->map_corrections) return correction_t::MAP_CORRECTED;
  const bool is_after_gap = now.is_taking_back || !before_->is_measured;
  return is_after_gap ? correction_t::MEASURED_AGAIN : correction_t::MAP_ADJUSTED;
}

}  // namespace edgeslam
