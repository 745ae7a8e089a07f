#include "geometry/uncertainty.h"

#include <Eigen/Cholesky>

namespace edgeslam {

Eigen::Matrix3d whiteningOf(const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d lower = covariance.llt().matrixL();
  return lower.triangularView<Eigen::Lower>().solve(Eigen::Matrix3d::Identity());
}

Matrix7d updateCarrying(const Pose& a_T_b) {
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

Matrix7d carriedUncertainty(const Matrix7d& of_a, const Pose& a_T_b) {
  const Matrix7d carry = updateCarrying(a_T_b);
  return carry * of_a * carry.transpose();
}

Matrix6d carriedCovariance(const Matrix6d& covariance, const Pose& a_T_b) {
  const Eigen::Matrix3d b_R_a = a_T_b.rotation.conjugate().toRotationMatrix();
  Matrix6d carried = Matrix6d::Zero();
  carried.topLeftCorner<3, 3>() = b_R_a;
  carried.topRightCorner<3, 3>() = -b_R_a * skew(a_T_b.translation);
  carried.bottomRightCorner<3, 3>() = b_R_a;
  return carried * covariance * carried.transpose();
}

}  // namespace edgeslam
