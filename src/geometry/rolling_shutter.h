// Rolling shutter: an image's rows are read one after another, so that each has a pose of its own. A frame's pose and
// time are those of its middle row's mid-exposure (design, section 5: rolling shutter).
#pragma once

#include "geometry/camera.h"
#include "geometry/pose.h"

namespace edgeslam {

// Motion of a camera while its rows are read [map units/s; rad/s], in its own frame, as the update of retract().
using Twist = Vector6d;

// A camera while it reads an image; one of which a pose alone is known stands.
struct MovingCamera {
  MovingCamera(const Pose& pose, const Twist& motion = Twist::Zero()) : world_T_camera(pose), twist(motion) {}

  Pose world_T_camera;  // at the middle row
  Twist twist;
};

// When a row is read, after the middle one [s].
inline double rowTime(const Camera& camera, double row) {
  return camera.height > 1 ? (row / (camera.height - 1) - 0.5) * camera.readout_s : 0.0;
}

// camera_T_row: where a camera is that moves so for this long.
inline Pose movedFor(const Twist& twist, double seconds) { return retract(Pose(), seconds * twist); }

// camera_T_row: where the camera is as it reads a row; the identity for a global shutter.
inline Pose rowPose(const Camera& camera, const Twist& twist, double row) {
  return camera.readout_s == 0 ? Pose() : movedFor(twist, rowTime(camera, row));
}

// Where the camera is as it reads a row, world frame.
inline Pose worldTRow(const Camera& camera, const MovingCamera& moving, double row) {
  return camera.readout_s == 0 ? moving.world_T_camera : moving.world_T_camera * rowPose(camera, moving.twist, row);
}

// A ray of the middle row's camera frame.
struct Ray {
  Eigen::Vector3d origin, direction;
};

// The ray of a bearing measured in a row.
inline Ray rayOfRow(const Camera& camera, const Twist& twist, double row, const Eigen::Vector3d& bearing) {
  if (camera.readout_s == 0) return {Eigen::Vector3d::Zero(), bearing};
  const Pose camera_T_row = rowPose(camera, twist, row);
  return {camera_T_row.translation, camera_T_row.rotation * bearing};
}

// The steady motion that takes a camera from one pose to the next within `seconds`; and its derivative by the latter
// pose's update where asked for.
Twist twistBetween(const Pose& world_T_before, const Pose& world_T_now, double seconds, Matrix6d* by_now = nullptr);

// How a camera moves while its rows are read, as far as it is known before its pose is: its poses tell it. Between the
// frame before and this one it moved steadily, and changed its motion since then as it did in the time before.
struct RowMotion {
  Pose world_T_before;
  double seconds = 0;                 // since the frame before; 0: the motion is known to be `before`
  Twist before = Twist::Zero();       // of the frame before
  bool is_known_from_before = false;  // there was a motion before
};

// The motion as a pose of the frame tells it, and its derivative by that pose's update where asked for.
Twist twistOf(const RowMotion& motion, const Pose& world_T_camera, Matrix6d* by_pose = nullptr);

// Pixel of a point in the middle row's camera frame, in whatever row it is seen. As project(), and valid for what that
// is valid for.
Eigen::Vector2d projectToRow(const Camera& camera, const Twist& twist, const Eigen::Vector3d& point);

// J of exp(v + d) = exp(v) exp(J d), to first order in d (Sola et al., A micro Lie theory, 2018, equation 143).
Eigen::Matrix3d rightJacobian(const Eigen::Vector3d& rotation_vector);

}  // namespace edgeslam
