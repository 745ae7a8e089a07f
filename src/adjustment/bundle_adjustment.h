// P19, eq. 1: bundle adjustment of keyframe poses, inverse depths and straight lines. A point is one unknown: its
// inverse distance rho along the fixed unit bearing in its host camera, X_host = bearing / rho. Residuals are whitened
// across and along the edge; a line is four unknowns, and what is seen of it has residuals across it.
// Levenberg-Marquardt's method minimises them with the depths and lines eliminated first, a depth by a division.
#pragma once

#include <atomic>
#include <vector>

#include "geometry/camera.h"
#include "geometry/measurement.h"
#include "geometry/pose.h"
#include "geometry/rolling_shutter.h"
#include "geometry/space_line.h"

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

struct BundleLine {
  SpaceLine line;  // world frame
  bool fixed = false;
};

// A ray on which a line is seen: two of them, to its ends, say all that a view of a straight edge does.
struct BundleLineObservation {
  int camera = 0;
  int line = 0;
  Eigen::Vector3d bearing;  // unit, camera frame of the row where it was measured
  double row = 0;           // that row [px]; matters where the camera moves while it is read
  double sigma = 0;         // standard deviation across the line [rad]
};

struct BundleProblem {
  std::vector<BundleCamera> cameras;
  std::vector<BundlePoint> points;
  std::vector<BundleObservation> observations;
  std::vector<BundleLine> lines;
  std::vector<BundleLineObservation> line_observations;
  // Where over 0: the distance of this camera's centre from camera 0's is kept (the gauge of scale when only camera 0
  // is fixed), by scaling all centres and lines about camera 0 and all depths. Ignored where another camera, a point or
  // a line is fixed, as that holds the scale.
  int scale_camera = -1;
};

struct BundleOptions {
  int iterations = 8;
  double huber = 2.0;  // whitened, of the norm of an observation's two residuals, or of a line's one
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
  // Absolute whitened residual of each line observation afterwards; infinity where the line is seen end-on, and for
  // what takes no part: values that are not finite, directions and bearings that are not unit, sigmas not over 0.
  std::vector<double> line_errors;
  // Covariance of each line's change (4, as of movedLine()) from where it is afterwards, with the poses held, outliers
  // down-weighed. Variances are at most 1e6, for what is not determined; 0 where the line is unobserved.
  std::vector<Eigen::Matrix4d> line_covariances;
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
