// Pose of one camera from points of known depth: robust Gauss-Newton on the whitened edge measurements (design, section 5).
#pragma once

#include <vector>

#include "geometry/camera.h"
#include "geometry/measurement.h"
#include "geometry/pose.h"

namespace edgeslam {

struct PoseObservation {
  Eigen::Vector3d point;       // world frame
  Measurement measurement;
  double depth_sigma_px = 0;   // standard deviation [px] that the point's own depth uncertainty adds along `depth_direction`
  Eigen::Vector2d depth_direction = Eigen::Vector2d::UnitX();  // unit, image direction in which the point moves with its depth
};

struct PoseOptions {
  int iterations = 10;
  double huber = 1.5;         // whitened, of the norm of a measurement's two residuals
  double outlier = 3.0;       // whitened norm over which a measurement counts as an outlier
  int fewest = 10;            // fewer observations, or inliers at the end: no pose
};

struct PoseResult {
  bool converged = false;     // false: too few observations or inliers, or the normal equations are singular; the pose is the start's
  Pose world_T_camera;
  Matrix6d covariance = Matrix6d::Zero();  // of the right-hand update [translation; rotation], inverse of the robust information
  std::vector<char> inliers;  // one an observation
  int inlier_count = 0;
  double rms = 0;             // of the inliers' whitened residual norms
};

// Behind-camera observations count as outliers. The covariance is scaled up by the residuals where these exceed 1, never down.
PoseResult adjustPose(const Camera& camera, const Pose& initial_world_T_camera,
                      const std::vector<PoseObservation>& observations, const PoseOptions& options);

}  // namespace edgeslam
