// P21, track-loss recovery (section 3.4.2 of the paper, eqs. 2 to 7): where the current frame t can't be resectioned
// but tracks run through it and the last two keyframes t-2 and t-1, the three are reconstructed by themselves in a
// local frame L, the camera frame of t-1; the distance of the known camera centres gives L its scale, and the pose of t
// is carried over.
#pragma once

#include <string>
#include <vector>

#include "adjustment/bundle_adjustment.h"
#include "adjustment/pose_adjustment.h"
#include "geometry/camera.h"
#include "map/map.h"

namespace edgeslam {

struct RecoveryOptions {
  int fewest_inliers = 100;              // points that must fit all three views ...
  double inlier_share = 0.5;             // ... or this share of the tracks, where the scene has less
  int fewest_tracks = 20;                // through the three views, to try at all
  double epipolar_error = 1.0;           // of an inlier of the five-point algorithm [px]
  double resectioning_error = 3.0;       // of an inlier of the resectioning of t-2 [px]
  double outlier = 3.0;                  // whitened reprojection error
  double largest_depth_sigma = 0.2;      // a point counts where its depth's standard deviation is below this share
  double least_parallax_deg = 0.5;       // median angle between the rays from t-1 and t, and from t-1 and t-2
  double largest_scale_sigma = 0.1;      // standard deviation of the scale, share of it
  double rotation_difference_deg = 2;    // of t-2 against t-1, in L and in the map ...
  double direction_difference_deg = 15;  // ... and of the direction from one to the other
  double largest_miss = 20;  // whitened, of a point of the map from where the pose found has it: it is something else
  BundleOptions bundle{20, 2.0};
};

// A track with the depth that the recovery gave it; hosted in keyframe t-1.
struct RecoveredPoint {
  PointId id = 0;
  Eigen::Vector3d host_bearing;  // unit, camera frame of t-1
  double inverse_depth = 0;      // [1 / map unit]
  double inverse_depth_sigma = 0;
  bool corner = false;
  int chain = -1;  // of t-1's edges
  int order = 0;
};

struct RecoveryResult {
  bool found = false;
  std::string reason;   // why not
  Pose world_T_camera;  // of t
  Matrix6d covariance =
      Matrix6d::Zero();                // of its right-hand update [translation; rotation], the scale's doubt included
  std::vector<RecoveredPoint> points;  // ascending by id
  std::vector<PointId> misfits;        // tracks through the three views that contradict them, ascending
  int tracks = 0;                      // through the three views
  int inliers = 0;
  double scale = 0;  // eq. 2: map units per unit of L
};

// Observations of the keyframes sorted by point. The tracks are known by their ids alone; what the map may know of
// their depths is not used. Same input, same result.
RecoveryResult recoverTrackLoss(const Camera& camera, const Keyframe& t_minus_2, const Keyframe& t_minus_1,
                                const TrackedFrame& t, const RecoveryOptions& options);

// Takes what contradicts the pose found out of the frame's observations: misfits, and points of the map that are
// elsewhere. As a keyframe the frame would bend the map by them: of a torn image they are half of all.
void leaveOutContradictions(const Camera& camera, const Map& map, const RecoveryResult& found, double largest_miss,
                            std::vector<PointObservation>& observations);

}  // namespace edgeslam
