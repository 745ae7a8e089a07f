#include "drivers/lcm/body_pose.h"

#include <cmath>

namespace edgeslam {
namespace {

// In the unit of the messages.
Pose scaled(const Pose& pose, const ScaleState& scale) {
  return {pose.rotation, scale.metres_per_unit * pose.translation};
}

Pose cameraOnBody(const RobotSetup& robot) {
  Pose body_T_camera = robot.body_T_camera;
  if (robot.scale.kind == ScaleKind::unknown) body_T_camera.translation.setZero();
  return body_T_camera;
}

bool isKnown(const Matrix6d& covariance) { return covariance.allFinite() && covariance.diagonal().minCoeff() > 0; }

}  // namespace

Pose bodyPose(const Pose& world_T_camera, const RobotSetup& robot) {
  const Pose body_T_camera = cameraOnBody(robot);
  return body_T_camera * scaled(world_T_camera, robot.scale) * body_T_camera.inverse();
}

Matrix6d bodyCovariance(const Matrix6d& covariance_camera, const RobotSetup& robot) {
  if (!isKnown(covariance_camera)) return unknown_variance * Matrix6d::Identity();
  Matrix6d covariance = covariance_camera;
  covariance.topRows<3>() *= robot.scale.metres_per_unit;
  covariance.leftCols<3>() *= robot.scale.metres_per_unit;
  return carriedCovariance(covariance, cameraOnBody(robot).inverse());
}

std::optional<BodyMotion> bodyMotion(const MeasuredPose& before, const MeasuredPose& now, const RobotSetup& robot) {
  const double seconds = 1e-9 * static_cast<double>(now.time_ns - before.time_ns);
  if (before.world != now.world || !(seconds > 0 && seconds <= longest_motion_s)) return std::nullopt;
  const Pose body_T_camera = cameraOnBody(robot);
  BodyMotion motion;
  motion.from_ns = before.time_ns;
  motion.seconds = seconds;
  motion.before_T_now = body_T_camera * scaled(cameraMotion(before, now), robot.scale) * body_T_camera.inverse();
  if (isKnown(before.covariance_camera) && isKnown(now.covariance_camera)) {
    motion.covariance = carriedCovariance(bodyCovariance(before.covariance_camera, robot), motion.before_T_now) +
                        bodyCovariance(now.covariance_camera, robot);
  } else {
    motion.covariance = unknown_variance * Matrix6d::Identity();
  }
  return motion;
}

}  // namespace edgeslam
