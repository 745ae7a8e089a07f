#include "drivers/lcm/body_pose.h"

#include <cmath>

namespace edgeslam {
namespace {

// In the unit of the messages.
Pose scaled(const Pose& pose, const ScaleState& scale) {
  return {pose.rotation, scale.metres_per_unit * pose.translation};
}

Matrix6d onBody(Matrix6d covariance, const RobotSetup& robot) {
  covariance.topRows<3>() *= robot.scale.metres_per_unit;
  covariance.leftCols<3>() *= robot.scale.metres_per_unit;
  return carriedCovariance(covariance, cameraOnBody(robot).inverse());
}

Pose onBody(const Pose& motion_of_camera, const RobotSetup& robot) {
  const Pose body_T_camera = cameraOnBody(robot);
  return body_T_camera * scaled(motion_of_camera, robot.scale) * body_T_camera.inverse();
}

bool isKnown(const Matrix6d& covariance) { return covariance.allFinite() && covariance.diagonal().minCoeff() > 0; }

}  // namespace

Pose cameraOnBody(const RobotSetup& robot) {
  Pose body_T_camera = robot.body_T_camera;
  if (robot.scale.kind == ScaleKind::unknown) body_T_camera.translation.setZero();
  return body_T_camera;
}

Eigen::Quaterniond worldTurnedUp(const RobotSetup& robot) {
  if (!robot.down) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond::FromTwoVectors(-*robot.down, Eigen::Vector3d::UnitZ());
}

Eigen::Quaterniond localTurnedUp(const RobotSetup& robot) {
  if (!robot.down) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond::FromTwoVectors(-(robot.body_T_camera.rotation * *robot.down), Eigen::Vector3d::UnitZ());
}

Pose cameraPose(const Pose& world_T_camera, const RobotSetup& robot) {
  return Pose{worldTurnedUp(robot), Eigen::Vector3d::Zero()} * scaled(world_T_camera, robot.scale);
}

Eigen::Vector3f pointInWorld(const Eigen::Vector3f& point, const RobotSetup& robot) {
  const Eigen::Vector3f in_metres = static_cast<float>(robot.scale.metres_per_unit) * point;
  return robot.down ? Eigen::Vector3f(worldTurnedUp(robot).cast<float>() * in_metres) : in_metres;
}

Pose bodyPose(const Pose& world_T_camera, const RobotSetup& robot) {
  return Pose{localTurnedUp(robot), Eigen::Vector3d::Zero()} * onBody(world_T_camera, robot);
}

Matrix6d bodyCovariance(const Matrix6d& covariance_camera, const RobotSetup& robot) {
  if (!isKnown(covariance_camera)) return unknown_variance * Matrix6d::Identity();
  return onBody(covariance_camera, robot);
}

std::optional<BodyMotion> bodyMotion(const MeasuredPose& before, const MeasuredPose& now, const RobotSetup& robot) {
  const double seconds = 1e-9 * static_cast<double>(now.time_ns - before.time_ns);
  if (before.world != now.world || !(seconds > 0 && seconds <= longest_motion_s)) return std::nullopt;
  BodyMotion motion;
  motion.from_ns = before.time_ns;
  motion.seconds = seconds;
  motion.before_T_now = onBody(cameraMotion(before, now), robot);
  if (isKnown(before.covariance_camera) && isKnown(now.covariance_camera)) {
    motion.covariance = carriedCovariance(bodyCovariance(before.covariance_camera, robot), motion.before_T_now) +
                        bodyCovariance(now.covariance_camera, robot);
  } else {
    motion.covariance = unknown_variance * Matrix6d::Identity();
  }
  return motion;
}

MotionStep bodyStep(const MotionStep& of_camera, const RobotSetup& robot) {
  MotionStep step = of_camera;
  step.before_T_now = onBody(of_camera.before_T_now, robot);
  step.taken_back = onBody(of_camera.taken_back, robot);
  step.drift = onBody(of_camera.drift, robot);
  step.pose_covariance = onBody(of_camera.pose_covariance, robot);
  return step;
}

}  // namespace edgeslam
