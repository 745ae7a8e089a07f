// Covariances as ROS has them (geometry_msgs): rows of a 6x6 matrix x, y, z, and rotation about x, y, z, all along and
// about the axes of the frame that the pose is in.
#pragma once

#include <array>

#include "geometry/pose.h"

namespace edgeslam {

using RosCovariance = std::array<double, 36>;  // row by row

// `covariance`: of parent_T_body, of a right-hand update [translation; rotation vector], so along and about the body's
// axes. The result's errors are parent_p' = parent_p + d and R' = exp(r) R: the body turns about its own origin, so
// that a rotation is no error of its position.
Matrix6d inParent(const Matrix6d& covariance, const Eigen::Quaterniond& parent_R_body);

// A position of which nothing is known, such as one whose metres are not: its variances are unknown_variance, and it
// has nothing in common with the rotation.
Matrix6d withoutPosition(Matrix6d covariance);

// A position [m] whose scale has this standard deviation, as a share: that error is along the position itself.
Matrix6d withScaleError(Matrix6d covariance_in_parent, const Eigen::Vector3d& position, double scale_sigma);

RosCovariance rosCovariance(const Matrix6d& covariance);

}  // namespace edgeslam
