// Where the robot's body is, from where its camera is: poses, motions and covariances through body_T_camera, in the
// unit of the messages (metres where the scale is known, map units where it is not).
#pragma once

#include <cstdint>
#include <optional>

#include "pipeline/frame_result.h"

namespace edgeslam {

enum class ScaleKind { unknown, known_distance, camera_height, odometry };

struct ScaleState {
  ScaleKind kind = ScaleKind::unknown;
  double metres_per_unit = 1;  // 1 while unknown
  double sigma = 0;            // standard deviation of the scale over the scale; 0 while unknown
};

struct RobotSetup {
  Pose body_T_camera;  // translation [m]
  ScaleState scale;
};

// A frame's measured pose, as the next frame's motion is told from it.
struct MeasuredPose {
  std::int64_t time_ns = 0;
  Pose world_T_camera;         // map units
  KeyframeId reference = -1;   // -1: none
  Pose reference_T_camera;     // map units
  Matrix6d covariance_camera;  // right-hand update [translation; rotation], map units and rad
};

struct BodyMotion {
  std::int64_t from_ns = 0;
  double seconds = 0;   // over 0
  Pose before_T_now;    // body(before)_T_body(now)
  Matrix6d covariance;  // right-hand update, in the frame of the later body
};

constexpr double unknown_variance = 1e6;
constexpr double longest_motion_s = 0.5;  // between two measured poses that give a motion

// A finite pose with a quaternion that can be normalized.
bool hasUsablePose(const FrameResult& result);

// None where the pose was not measured, or cannot be used.
std::optional<MeasuredPose> measuredPose(const FrameResult& result);

// Covariance of the right-hand update of x_T_b = x_T_a * a_T_b, from that of x_T_a.
Matrix6d carriedCovariance(const Matrix6d& covariance, const Pose& a_T_b);

// local_T_body. While the scale is unknown, the camera's place on the robot (metres) cannot be told in map units: the
// body then has its own orientation and the camera's position.
Pose bodyPose(const Pose& world_T_camera, const RobotSetup& robot);

// Covariance of local_T_body, right-hand update in the body's frame; unknown_variance on the diagonal where the
// camera's is not finite or claims certainty.
Matrix6d bodyCovariance(const Matrix6d& covariance_camera, const RobotSetup& robot);

// before_T_now [map units]: through the keyframe that both hang on, where there is one.
Pose cameraMotion(const MeasuredPose& before, const MeasuredPose& now);

// None where the time between is not over 0 or over longest_motion_s. By cameraMotion(), so that a correction of
// the map in between is no motion where the keyframe is the same.
std::optional<BodyMotion> bodyMotion(const MeasuredPose& before, const MeasuredPose& now, const RobotSetup& robot);

}  // namespace edgeslam
