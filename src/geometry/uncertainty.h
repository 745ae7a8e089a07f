// How uncertain a camera's pose in the world and the scale around it are together: the covariance of a right-hand
// update [translation; rotation vector; logarithm of the scale], which takes a point x in the camera's frame to x + t +
// r x x + s x (a small similarity).
#pragma once

#include <Eigen/Cholesky>

#include "geometry/pose.h"

namespace edgeslam {

using Matrix7d = Eigen::Matrix<double, 7, 7>;

// W with W^T W the inverse of a covariance.
inline Eigen::Matrix3d whiteningOf(const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d lower = covariance.llt().matrixL();
  return lower.triangularView<Eigen::Lower>().solve(Eigen::Matrix3d::Identity());
}

// The update of camera b that goes with an update of camera a which takes b along.
inline Matrix7d updateCarrying(const Pose& a_T_b) {
  const Pose b_T_a = a_T_b.inverse();
  const Eigen::Matrix3d turn = b_T_a.rotation.toRotationMatrix();
  Matrix7d carry = Matrix7d::Zero();
  carry.block<3, 3>(0, 0) = turn;
  carry.block<3, 3>(0, 3) = skew(b_T_a.translation) * turn;
  carry.block<3, 1>(0, 6) = -b_T_a.translation;
  carry.block<3, 3>(3, 3) = turn;
  carry(6, 6) = 1;
  return carry;
}

// Uncertainty of camera b, which is where it is by being known relative to camera a, from that of a.
inline Matrix7d carriedUncertainty(const Matrix7d& of_a, const Pose& a_T_b) {
  const Matrix7d carry = updateCarrying(a_T_b);
  return carry * of_a * carry.transpose();
}

// Covariance of the right-hand update of x_T_b = x_T_a * a_T_b, from that of x_T_a.
inline Matrix6d carriedCovariance(const Matrix6d& covariance, const Pose& a_T_b) {
  const Eigen::Matrix3d b_R_a = a_T_b.rotation.conjugate().toRotationMatrix();
  Matrix6d carried = Matrix6d::Zero();
  carried.topLeftCorner<3, 3>() = b_R_a;
  carried.topRightCorner<3, 3>() = -b_R_a * skew(a_T_b.translation);
  carried.bottomRightCorner<3, 3>() = b_R_a;
  return carried * covariance * carried.transpose();
}

}  // namespace edgeslam
