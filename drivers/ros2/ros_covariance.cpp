#include "drivers/ros2/ros_covariance.h"

#include "drivers/lcm/body_pose.h"

namespace edgeslam {

Matrix6d inParent(const Matrix6d& covariance, const Eigen::Quaterniond& parent_R_body) {
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = parent_R_body.toRotationMatrix();
  return turn * covariance * turn.transpose();
}

Matrix6d withoutPosition(Matrix6d covariance) {
  covariance.topRows<3>().setZero();
  covariance.leftCols<3>().setZero();
  covariance.diagonal().head<3>().setConstant(unknown_variance);
  return covariance;
}

Matrix6d withScaleError(Matrix6d covariance_in_parent, const Eigen::Vector3d& position, double scale_sigma) {
  covariance_in_parent.topLeftCorner<3, 3>() += scale_sigma * scale_sigma * position * position.transpose();
  return covariance_in_parent;
}

RosCovariance rosCovariance(const Matrix6d& covariance) {
  RosCovariance rows{};
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(rows.data()) = covariance;
  return rows;
}

}  // namespace edgeslam
