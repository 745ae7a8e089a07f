// P19, eq. 1: bundle adjustment of keyframe poses and inverse depths. A point is one unknown: its inverse distance rho along
// the fixed unit bearing in its host camera, X_host = bearing / rho. Residuals are whitened across and along the edge, with
// analytic Jacobians; Ceres minimises them with the points eliminated first (1x1 blocks).
#pragma once

#include <vector>

#include "geometry/camera.h"
#include "geometry/measurement.h"
#include "geometry/pose.h"

namespace edgeslam {

struct BundleCamera {
  Pose world_T_camera;
  bool fixed = false;
};

struct BundlePoint {
  int host = 0;  // index of the host camera
  Eigen::Vector3d host_bearing;
  double inverse_depth = 1;
  bool fixed = false;
  double prior_sigma = 0;          // over 0: a prior on the inverse depth with this standard deviation ...
  double prior_inverse_depth = 1;  // ... around this value
};

struct BundleObservation {
  int camera = 0;  // not the point's host: the host's own view has no residual
  int point = 0;
  Measurement measurement;
};

struct BundleProblem {
  std::vector<BundleCamera> cameras;
  std::vector<BundlePoint> points;
  std::vector<BundleObservation> observations;
  // Where over -1: the distance of this camera's centre from camera 0's is kept (the gauge of scale when only camera 0 is fixed).
  int scale_camera = -1;
};

struct BundleOptions {
  int iterations = 8;
  double huber = 2.0;     // whitened, of the norm of an observation's two residuals
};

struct BundleResult {
  bool usable = false;                 // Ceres found a usable solution and all values are finite; else the problem is as it was
  std::vector<double> errors;          // whitened residual norm of each observation afterwards; infinity behind the camera
  std::vector<double> depth_sigmas;    // standard deviation of each point's inverse depth with the poses held (0 where none)
  double initial_cost = 0;
  double final_cost = 0;
  int iterations = 0;
};

// Optimises the problem in place. The same input gives the same output to the last bit (one thread, no clock).
BundleResult adjustBundle(const Camera& camera, BundleProblem& problem, const BundleOptions& options);

}  // namespace edgeslam
