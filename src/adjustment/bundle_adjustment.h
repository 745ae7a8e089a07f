// P19, eq. 1: bundle adjustment of keyframe poses and inverse depths. A point is one unknown: its inverse distance rho
// along the fixed unit bearing in its host camera, X_host = bearing / rho. Residuals are whitened across and along the
// edge; Levenberg-Marquardt's method minimises them with the depths eliminated first, each a division.
#pragma once

#include <atomic>
#include <vector>

#include "geometry/camera.h"
#include "geometry/measurement.h"
#include "geometry/pose.h"
#include "geometry/rolling_shutter.h"

namespace edgeslam {

struct BundleCamera {
  Pose world_T_camera;
  bool fixed = false;
  Twist twist = Twist::Zero();  // its motion while its rows are read; taken as it is
};

struct BundlePoint {
  int host = 0;                  // index of the host camera
  Eigen::Vector3d host_bearing;  // unit, host camera frame
  double inverse_depth = 1;
  bool fixed = false;
  double prior_sigma = 0;          // over 0: a prior on the inverse depth with this standard deviation ...
  double prior_inverse_depth = 1;  // ... around this value
  // Where the bearing starts from, host camera frame: not its centre where the host moved as it read the row.
  Eigen::Vector3d host_origin = Eigen::Vector3d::Zero();
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
  // Where over 0: the distance of this camera's centre from camera 0's is kept (the gauge of scale when only camera 0
  // is fixed), by scaling all centres about camera 0 and all depths. Ignored where another camera or a point is fixed,
  // as that holds the scale.
  int scale_camera = -1;
};

struct BundleOptions {
  int iterations = 8;
  double huber = 2.0;  // whitened, of the norm of an observation's two residuals
};

struct BundleResult {
  // Something was adjusted, a step could be computed and all of it is finite. Else the problem is as it was: also
  // where an index is out of range or a camera's pose not finite.
  bool usable = false;
  // Whitened residual norm of each observation afterwards; infinity behind the camera, and for what takes no part:
  // measurements and points with values that are not finite, sigmas or inverse depths not over 0.
  std::vector<double> errors;
  // Standard deviation of each point's inverse depth with the poses held, outliers down-weighed (0 where unobserved).
  std::vector<double> depth_sigmas;
  double initial_cost = 0;
  double final_cost = 0;
  int iterations = 0;
};

// Optimises the problem in place. The same input gives the same output to the last bit (one thread, no clock).
// Observations that are behind their camera count as constants until the others bring them before it. Inverse depths
// stay over 0. Where `interrupted` is given and becomes true, the adjustment is given up: not usable.
BundleResult adjustBundle(const Camera& camera, BundleProblem& problem, const BundleOptions& options,
                          const std::atomic<bool>* interrupted = nullptr);

}  // namespace edgeslam
