// Where the robot's body is, from where its camera is: poses, motions and covariances through body_T_camera, in the
// unit of the messages (metres where the scale is known, map units where it is not).
#pragma once

#include <cstdint>
#include <optional>

#include "scale/measured_pose.h"
#include "scale/scale_state.h"
#include "visual_odometry/motion_step.h"

namespace edgeslam {

struct RobotSetup {
  Pose body_T_camera;  // translation [m]
  ScaleState scale;
  // Where inertia tells it, unit, in the world as the map has it; none: `world` and `local` stay as the map began.
  std::optional<Eigen::Vector3d> down{};
};

struct BodyMotion {
  std::int64_t from_ns = 0;
  double seconds = 0;   // over 0
  Pose before_T_now;    // body(before)_T_body(now)
  Matrix6d covariance;  // right-hand update, in the frame of the later body
};

constexpr double unknown_variance = 1e6;
constexpr double longest_motion_s = 0.5;  // between two measured poses that give a motion

// The camera's place on the robot in the unit of the messages; none while the scale is unknown.
Pose cameraOnBody(const RobotSetup& robot);

// What makes z point up, about the origin, by the least turn: of `world` and of `local`; the identity where it is not
// known where down is.
Eigen::Quaterniond worldTurnedUp(const RobotSetup& robot);
Eigen::Quaterniond localTurnedUp(const RobotSetup& robot);

// world_T_camera in the unit of the messages, z up where that is known; and so a point of the map.
Pose cameraPose(const Pose& world_T_camera, const RobotSetup& robot);
Eigen::Vector3f pointInWorld(const Eigen::Vector3f& point, const RobotSetup& robot);

// local_T_body. While the scale is unknown, the camera's place on the robot (metres) cannot be told in map units: the
// body then has its own orientation and the camera's position.
Pose bodyPose(const Pose& world_T_camera, const RobotSetup& robot);

// Covariance of local_T_body, right-hand update in the body's frame; unknown_variance on the diagonal where the
// camera's is not finite or claims certainty.
Matrix6d bodyCovariance(const Matrix6d& covariance_camera, const RobotSetup& robot);

// None between two worlds, or where the time between is not over 0 or over longest_motion_s. By cameraMotion(), so that
// a correction of the map in between is no motion where the keyframe is the same.
std::optional<BodyMotion> bodyMotion(const MeasuredPose& before, const MeasuredPose& now, const RobotSetup& robot);

// The body's motion for the camera's, and its covariances likewise.
MotionStep bodyStep(const MotionStep& of_camera, const RobotSetup& robot);

}  // namespace edgeslam
