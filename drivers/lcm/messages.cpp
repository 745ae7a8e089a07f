#include "drivers/lcm/messages.h"

#include <algorithm>
#include <cmath>

#include "drivers/lcm/message_fields.h"

namespace edgeslam {
namespace {

constexpr std::size_t longest_text = 200;

struct BodyTwist {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();       // body frame
  Eigen::Vector3d rotation_rate = Eigen::Vector3d::Zero();  // body frame [rad/s]
};

BodyTwist twistOf(const BodyMotion& motion) {
  const Pose& moved = motion.before_T_now;
  return {moved.rotation.conjugate() * moved.translation / motion.seconds,
          rotationLog(moved.rotation) / motion.seconds};
}

state_t stateMessage(const FrameResult& result, const RobotSetup& robot, const BodyTwist* twist) {
  state_t state;
  state.utime = utimeOf(result.time_ns);
  state.frame = result.index;
  state.has_pose = hasUsablePose(result);
  state.world = worldOf(result);
  const bool broken = result.has_pose && !state.has_pose;
  state.state = stateNumber(broken ? TrackingState::lost : result.state);
  state.reason = messageText(broken ? "the pose is not finite" : result.reason);

  Pose world_T_camera;
  if (state.has_pose) {
    world_T_camera = {result.world_T_camera.rotation.normalized(), result.world_T_camera.translation};
  }
  const Pose local_T_body = bodyPose(world_T_camera, robot);
  put(local_T_body.translation, state.position);
  put(local_T_body.rotation, state.orientation);
  const Pose of_camera = cameraPose(world_T_camera, robot);
  put(of_camera.translation, state.camera_position);
  put(of_camera.rotation, state.camera_orientation);
  put(bodyCovariance(state.has_pose ? result.world_covariance : Matrix6d::Zero(), robot), state.covariance);

  state.has_twist = twist != nullptr;
  put(twist ? twist->velocity : Eigen::Vector3d::Zero(), state.velocity);
  put(twist ? twist->rotation_rate : Eigen::Vector3d::Zero(), state.rotation_rate);

  state.scale_state = scaleNumber(robot.scale.kind);
  state.scale = robot.scale.metres_per_unit;
  state.scale_sigma = robot.scale.sigma;
  state.latency_ms = std::isfinite(result.latency_ms) ? result.latency_ms : -1;
  state.points_tracked = result.tracked_points;
  state.points_mapped = result.mapped_points;
  return state;
}

pose_t poseMessage(const state_t& state) {
  pose_t pose;
  pose.utime = state.utime;
  std::copy_n(state.position, 3, pose.pos);
  std::copy_n(state.orientation, 4, pose.orientation);
  std::copy_n(state.velocity, 3, pose.vel);
  std::copy_n(state.rotation_rate, 3, pose.rotation_rate);
  std::fill_n(pose.accel, 3, 0.0);
  return pose;
}

std::int8_t updateStatus(TrackingState state, bool has_motion) {
  if (has_motion) return update_t::ESTIMATE_VALID;
  const bool without_pose = state == TrackingState::lost || state == TrackingState::predicted;
  return without_pose ? update_t::ESTIMATE_INSUFFICIENT_FEATURES : update_t::NO_DATA;
}

update_t updateMessage(const FrameResult& result, const std::optional<BodyMotion>& motion) {
  update_t update;
  update.timestamp = utimeOf(result.time_ns);
  update.prev_timestamp = motion ? utimeOf(motion->from_ns) : update.timestamp;
  put(motion ? motion->before_T_now.translation : Eigen::Vector3d::Zero(), update.translation);
  put(motion ? motion->before_T_now.rotation : Eigen::Quaterniond::Identity(), update.rotation);
  put(motion ? motion->covariance : Matrix6d(unknown_variance * Matrix6d::Identity()), update.covariance);
  update.estimate_status = updateStatus(result.state, motion.has_value());
  return update;
}

}  // namespace

LcmFrame frameMessages(const FrameResult& result, const RobotSetup& robot, const std::optional<MeasuredPose>& before,
                       std::int64_t sequence, std::int64_t publish_utime) {
  const std::optional<MeasuredPose> now = measuredPose(result);
  std::optional<BodyMotion> motion;
  if (now && before) motion = bodyMotion(*before, *now, robot);
  BodyTwist twist;
  if (motion) twist = twistOf(*motion);

  LcmFrame messages;
  messages.state = stateMessage(result, robot, motion ? &twist : nullptr);
  messages.state.sequence = sequence;
  messages.state.publish_utime = publish_utime;
  if (now) messages.pose = poseMessage(messages.state);
  messages.update = updateMessage(result, motion);
  return messages;
}

std::int8_t stateNumber(TrackingState state) {
  switch (state) {
    case TrackingState::initialising:
      return state_t::INITIALISING;
    case TrackingState::tracking:
      return state_t::TRACKING;
    case TrackingState::predicted:
      return state_t::PREDICTED;
    case TrackingState::recovered:
      return state_t::RECOVERED;
    case TrackingState::relocalised:
      return state_t::RELOCALISED;
    case TrackingState::lost:
      break;
  }
  return state_t::LOST;
}

std::int8_t scaleNumber(ScaleKind kind) {
  switch (kind) {
    case ScaleKind::known_distance:
      return state_t::SCALE_FROM_KNOWN_DISTANCE;
    case ScaleKind::camera_height:
      return state_t::SCALE_FROM_CAMERA_HEIGHT;
    case ScaleKind::odometry:
      return state_t::SCALE_FROM_ODOMETRY;
    case ScaleKind::inertia:
      return state_t::SCALE_FROM_INERTIA;
    case ScaleKind::unknown:
      break;
  }
  return state_t::SCALE_UNKNOWN;
}

std::string messageText(const std::string& text) {
  std::string kept = text.substr(0, longest_text);
  std::replace_if(
      kept.begin(), kept.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return kept;
}

}  // namespace edgeslam
