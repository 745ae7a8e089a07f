#include "geometry/rolling_shutter.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace edgeslam {

Twist twistBetween(const Pose& world_T_before, const Pose& world_T_now, double seconds, Matrix6d* by_now) {
  const Pose before_T_now = world_T_before.inverse() * world_T_now;
  const Eigen::Vector3d way = before_T_now.rotation.conjugate() * before_T_now.translation;
  const Eigen::Vector3d turn = rotationLog(before_T_now.rotation);
  Twist twist;
  twist << way / seconds, turn / seconds;
  if (by_now) {
    by_now->setZero();
    by_now->topLeftCorner<3, 3>().diagonal().setConstant(1 / seconds);
    by_now->topRightCorner<3, 3>() = skew(way) / seconds;
    by_now->bottomRightCorner<3, 3>() = rightJacobian(turn).inverse() / seconds;
  }
  return twist;
}

Twist twistOf(const RowMotion& motion, const Pose& world_T_camera, Matrix6d* by_pose) {
  if (!(motion.seconds > 0)) {
    if (by_pose) by_pose->setZero();
    return motion.before;
  }
  const Twist since = twistBetween(motion.world_T_before, world_T_camera, motion.seconds, by_pose);
  if (!motion.is_known_from_before) return since;
  // `since` is of half a frame interval ago.
  if (by_pose) *by_pose *= 1.5;
  return since + 0.5 * (since - motion.before);
}

// The row is where the point is seen, which hangs on the row: a camera turns little while it reads the pixels that it
// turned by, so that two rounds are enough.
Eigen::Vector2d projectToRow(const Camera& camera, const Twist& twist, const Eigen::Vector3d& point) {
  Eigen::Vector2d pixel = project(camera, point);
  if (camera.readout_s == 0) return pixel;
  for (int round = 0; round < 2; ++round) {
    const double row = std::clamp(pixel.y(), 0.0, camera.height - 1.0);
    const Eigen::Vector3d seen = rowPose(camera, twist, row).inverse() * point;
    if (!(seen.z() > 0)) return pixel;
    pixel = project(camera, seen);
  }
  return pixel;
}

Eigen::Matrix3d rightJacobian(const Eigen::Vector3d& rotation_vector) {
  const double s = rotation_vector.squaredNorm();
  // (1 - cos) / angle^2 and (angle - sin) / angle^3.
  double first = 0.5 - 1.0 / 24 * s * (1 - 1.0 / 30 * s * (1 - 1.0 / 56 * s * (1 - 1.0 / 90 * s)));
  double second = 1.0 / 6 - 1.0 / 120 * s * (1 - 1.0 / 42 * s * (1 - 1.0 / 72 * s * (1 - 1.0 / 110 * s)));
  if (!(s < most_squared_for_series)) {
    const double angle = std::sqrt(s);
    first = (1 - std::cos(angle)) / s;
    second = (angle - std::sin(angle)) / (s * angle);
  }
  // The square of skew(v) is v v^T - |v|^2 I.
  Eigen::Matrix3d jacobian = second * rotation_vector * rotation_vector.transpose() - first * skew(rotation_vector);
  jacobian.diagonal().array() += 1 - second * s;
  return jacobian;
}

}  // namespace edgeslam
