// Pose of one camera from points of known depth: robust Gauss-Newton on the whitened edge measurements
// (design, section 5).
#pragma once

#include <memory_resource>
#include <vector>

#include "geometry/camera.h"
#include "geometry/measurement.h"
#include "geometry/pose.h"
#include "geometry/rolling_shutter.h"
#include "geometry/similarity.h"

namespace edgeslam {

struct PoseObservation {
  Eigen::Vector3d point;  // world frame
  Measurement measurement;
  // Standard deviation [px] that the uncertainty of the point's own depth adds, along the unit direction in which the
  // point moves in the image with its depth.
  double depth_sigma_px = 0;
  Eigen::Vector2d depth_direction = Eigen::Vector2d::UnitX();
};

// A point as its host keyframe knows it.
struct HostedPoint {
  Eigen::Vector3d host_bearing;  // unit, host camera frame
  double inverse_depth = 0;
  double inverse_depth_sigma = 0;
};

// What is seen of a point, with the uncertainty that its depth adds along the epipolar direction from where the camera
// is taken to be.
PoseObservation observeWithDepth(const Camera& camera, const Pose& camera_T_host, const HostedPoint& point,
                                 const Eigen::Vector3d& world_position, const Measurement& measurement);

using PoseObservations = std::pmr::vector<PoseObservation>;

struct PoseOptions {
  int iterations = 10;
  double huber = 1.5;    // whitened, of the norm of a measurement's two residuals
  double outlier = 3.0;  // whitened norm over which a measurement counts as an outlier
  int fewest = 10;       // fewer observations, or inliers at the end: no pose
};

// Where the camera is held to be before anything is measured.
struct PosePrior {
  Pose world_T_camera;
  // Inverse covariance of the right-hand update [translation; rotation] there; zero where nothing is known.
  Matrix6d information = Matrix6d::Zero();
};

PosePrior moved(const Similarity& new_S_old, const PosePrior& prior);

struct PoseResult {
  explicit PoseResult(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : inliers(memory), errors_across(memory) {}

  // False: too few observations or inliers, or the normal equations are singular. The pose is the start's then.
  bool converged = false;
  Pose world_T_camera;
  Twist twist = Twist::Zero();  // as the pose tells it; 0 for a global shutter
  // Covariance of the right-hand update [translation; rotation]: inverse of the inliers' robust information, scaled up
  // by the residuals where these exceed what the sigmas say, never down. A direction that nothing measures has a large
  // variance.
  Matrix6d covariance = Matrix6d::Zero();
  std::pmr::vector<char> inliers;  // one an observation
  int inlier_count = 0;
  std::pmr::vector<double> errors_across;  // whitened, across its edge; one an observation, infinite behind the camera
  double rms = 0;                          // of the inliers' whitened residual norms
  // Right-hand update that takes the pose to where the observations have it without the prior; infinite where they do
  // not tell it.
  Vector6d without_prior = Vector6d::Zero();
};

// The pose is that of the middle row; where the camera reads its rows one after another, `motion` ties the other rows'
// poses to it. `prior` counts beside the observations, in the pose and in its covariance. Observations behind the
// camera, or with values that are not finite, count as outliers. `memory` serves the result and what is needed on the
// way.
PoseResult adjustPose(const Camera& camera, const Pose& initial_world_T_camera, const PoseObservations& observations,
                      const PoseOptions& options, std::pmr::memory_resource* memory = std::pmr::get_default_resource(),
                      const RowMotion& motion = {}, const PosePrior& prior = {});

// The robust cost of a pose, and its derivatives by the right-hand update: half of the gradient, and Gauss' and
// Newton's half of the second derivative.
struct PoseEquations {
  double cost = 0;
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
};

// What is measured says of a pose. The rows are read while the camera moves by its twist.
PoseEquations poseEquations(const Camera& camera, const MovingCamera& moving, const PoseObservations& observations,
                            const PoseOptions& options);

// What is known beforehand says of it: half of the cost's derivatives, as above.
PoseEquations priorEquations(const PosePrior& prior, const Pose& world_T_camera);

// Inverse covariance of the right-hand update [translation; rotation] that the observations' standard deviations give a
// camera there, whatever the residuals are.
Matrix6d poseInformation(const Camera& camera, const Pose& world_T_camera, const PoseObservations& observations);

}  // namespace edgeslam
