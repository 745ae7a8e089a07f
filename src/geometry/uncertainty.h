// How uncertain a camera's pose in the world and the scale around it are together: the covariance of a right-hand
// update [translation; rotation vector; logarithm of the scale], which takes a point x in the camera's frame to x + t +
// r x x + s x (a small similarity).
#pragma once

#include "geometry/pose.h"

namespace edgeslam {

using Matrix7d = Eigen::Matrix<double, 7, 7>;

// W with W^T W the inverse of a covariance.
Eigen::Matrix3d whiteningOf(const Eigen::Matrix3d& covariance);

// The update of camera b that goes with an update of camera a which takes b along.
Matrix7d updateCarrying(const Pose& a_T_b);

// Uncertainty of camera b, which is where it is by being known relative to camera a, from that of a.
Matrix7d carriedUncertainty(const Matrix7d& of_a, const Pose& a_T_b);

// Covariance of the right-hand update of x_T_b = x_T_a * a_T_b, from that of x_T_a.
Matrix6d carriedCovariance(const Matrix6d& covariance, const Pose& a_T_b);

}  // namespace edgeslam
