// Camera and board poses from corners of a board: minimisation of the reprojection error over all views (Zhang 2000),
// each corner weighted by what is known of its accuracy.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "geometry/camera.h"
#include "geometry/pose.h"

namespace edgeslam {

constexpr int camera_parameters = 9;  // fx fy cx cy, then the distortion's five
using CameraVector = Eigen::Matrix<double, camera_parameters, 1>;
using CameraMatrix = Eigen::Matrix<double, camera_parameters, camera_parameters>;

struct MeasuredCorner {
  int number = 0;                                           // on the board
  Eigen::Vector2d place_m;                                  // in the board frame, z = 0
  Eigen::Vector2d pixel;                                    // distorted [px]
  Eigen::Matrix2d whitening = Eigen::Matrix2d::Identity();  // takes an error [px] to units of its standard deviation
};

struct FittedView {
  std::vector<MeasuredCorner> corners;
  Pose camera_T_board;
};

struct FitOptions {
  std::array<bool, camera_parameters> free{};  // which of the camera's parameters are estimated; none: the poses alone
  double huber = 2.5;                          // errors beyond that many standard deviations count less
  int iterations = 60;
};

struct FitResult {
  bool converged = false;
  double cost = 0;  // half the sum of squares, large ones damped
  // Of the camera's parameters with all poses free, in the measurements' own units of accuracy; rows and columns of
  // parameters that are not free are 0.
  CameraMatrix information = CameraMatrix::Zero();
};

// Improves camera and poses from where they are, by Levenberg's and Marquardt's method, poses eliminated view by view.
FitResult fitCamera(Camera& camera, std::vector<FittedView>& views, const FitOptions& options);

// Error of a corner [px]; a large one where the point does not lie before the camera.
Eigen::Vector2d cornerError(const Camera& camera, const Pose& camera_T_board, const MeasuredCorner& corner);

// Root mean square of the distances [px] over all corners.
double rmsError(const Camera& camera, const std::vector<FittedView>& views);

// Covariance of the free parameters, from the information and the factor by which errors are larger than thought.
CameraMatrix parameterCovariance(const FitResult& fit, const FitOptions& options, double variance_factor);

// Derivative of project() by the parameters.
Eigen::Matrix<double, 2, camera_parameters> parameterJacobian(const Camera& camera, const Eigen::Vector3d& point);

// The camera with each parameter changed.
Camera changedCamera(const Camera& camera, const CameraVector& change);

}  // namespace edgeslam
