// The residual that every adjustment minimises, and its derivatives: whitening * (project(point) - pixel), with the
// point in the camera frame (design, section 5: what a measurement is). Derivatives by poses are by right-hand updates
// [translation; rotation vector] as in geometry/pose.h. Inline: these run for every point of every frame.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "geometry/camera.h"
#include "geometry/pose.h"
#include "geometry/rolling_shutter.h"

namespace edgeslam {

using Matrix23d = Eigen::Matrix<double, 2, 3>;
using Matrix26d = Eigen::Matrix<double, 2, 6>;

// A camera's pose as rotation matrix and centre, which is what residuals use many times over.
struct CameraFrame {
  Eigen::Matrix3d world_R_camera = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // world frame
};

inline CameraFrame cameraFrame(const Pose& world_T_camera) {
  return {world_T_camera.rotation.toRotationMatrix(), world_T_camera.translation};
}

// True where a point (camera frame, any scale) can be seen: within 88.9 degrees of the optical axis for the pinhole
// model, within 120 degrees for the fisheye. False for points at the centre and for NaN.
inline bool inFront(const Camera& camera, const Eigen::Vector3d& point) {
  if (camera.model == CameraModel::kannala_brandt) return point.z() > -0.5 * point.norm();
  constexpr double least_cosine = 0.02;
  return point.z() > 0 && point.z() * point.z() > least_cosine * least_cosine * point.squaredNorm();
}

// A pixel and what whitens errors of it.
struct WhitenedPixel {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Matrix2d whitening = Eigen::Matrix2d::Identity();
};

// Residual (2, whitened) of a point in the camera frame, and its derivative by the point where asked for. False, with
// nothing written, where the point is not in front of the camera.
inline bool pointResidual(const Camera& camera, const WhitenedPixel& measured, const Eigen::Vector3d& point,
                          Eigen::Vector2d& residual, Matrix23d* by_point) {
  if (!inFront(camera, point)) return false;
  if (!by_point) {
    residual = measured.whitening * (project(camera, point) - measured.pixel);
    return true;
  }
  Matrix23d projection;
  residual = measured.whitening * (project(camera, point, &projection) - measured.pixel);
  by_point->noalias() = measured.whitening * projection;
  return true;
}

// Residual of a known point (world frame), and its derivative by the camera's pose.
inline bool poseResidual(const Camera& camera, const WhitenedPixel& measured, const CameraFrame& frame,
                         const Eigen::Vector3d& point, Eigen::Vector2d& residual, Matrix26d* by_pose) {
  const Eigen::Vector3d seen = frame.world_R_camera.transpose() * (point - frame.centre);
  if (!by_pose) return pointResidual(camera, measured, seen, residual, nullptr);
  Matrix23d by_point;
  if (!pointResidual(camera, measured, seen, residual, &by_point)) return false;
  by_pose->leftCols<3>() = -by_point;
  by_pose->rightCols<3>().noalias() = by_point * skew(seen);
  return true;
}

// The same for a camera that moves by `twist` and reads the measured row `seconds` after the middle one; the
// derivatives are by the middle row's pose and, where asked for, by the twist.
inline bool rowResidual(const Camera& camera, const WhitenedPixel& measured, const CameraFrame& frame,
                        const Twist& twist, double seconds, const Eigen::Vector3d& point, Eigen::Vector2d& residual,
                        Matrix26d& by_pose, Matrix26d* by_twist) {
  const Eigen::Vector3d in_camera = frame.world_R_camera.transpose() * (point - frame.centre);
  const Eigen::Vector3d turn = seconds * twist.tail<3>();
  const Eigen::Matrix3d row_R_camera = rotationExp(turn).toRotationMatrix().transpose();
  const Eigen::Vector3d seen = row_R_camera * (in_camera - seconds * twist.head<3>());
  Matrix23d by_point;
  if (!pointResidual(camera, measured, seen, residual, &by_point)) return false;
  const Matrix23d by_point_in_camera = by_point * row_R_camera;
  by_pose.leftCols<3>() = -by_point_in_camera;
  by_pose.rightCols<3>().noalias() = by_point_in_camera * skew(in_camera);
  if (!by_twist) return true;
  by_twist->leftCols<3>() = -seconds * by_point_in_camera;
  by_twist->rightCols<3>().noalias() = seconds * (by_point * skew(seen)) * rightJacobian(turn);
  return true;
}

// Where a camera is as it reads a row.
inline CameraFrame rowFrame(const CameraFrame& camera, const CameraFrame& camera_T_row) {
  return {camera.world_R_camera * camera_T_row.world_R_camera,
          camera.centre + camera.world_R_camera * camera_T_row.centre};
}

// From a target camera's centre to the point at `inverse_depth` along the unit `host_bearing` of a host camera: world
// axes, divided by the point's depth, so that infinitely far points are nothing special.
inline Eigen::Vector3d sight(const CameraFrame& host, const CameraFrame& target, const Eigen::Vector3d& host_bearing,
                             double inverse_depth) {
  return host.world_R_camera * host_bearing + inverse_depth * (host.centre - target.centre);
}

// Residual of a point seen along `sight` (world axes, any length), and its derivative by the sight. All that a bundle
// adjustment moves acts through the sight: what a residual changes by is `by_sight` times what the sight does.
inline bool sightResidual(const Camera& camera, const WhitenedPixel& measured, const CameraFrame& target,
                          const Eigen::Vector3d& sight, Eigen::Vector2d& residual, Matrix23d* by_sight) {
  const Eigen::Vector3d seen = target.world_R_camera.transpose() * sight;
  if (!by_sight) return pointResidual(camera, measured, seen, residual, nullptr);
  Matrix23d by_point;
  if (!pointResidual(camera, measured, seen, residual, &by_point)) return false;
  by_sight->noalias() = by_point * target.world_R_camera.transpose();
  return true;
}

// Huber's weight of a residual of this norm: what multiplies its square in reweighted least squares.
inline double huberWeight(double norm, double huber) { return norm <= huber ? 1.0 : huber / norm; }

// Huber's loss of a squared norm: the square itself up to huber^2, linear in the norm beyond.
inline double huberLoss(double squared_norm, double huber) {
  return squared_norm <= huber * huber ? squared_norm : 2 * huber * std::sqrt(squared_norm) - huber * huber;
}

}  // namespace edgeslam
