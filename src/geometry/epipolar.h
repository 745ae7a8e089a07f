// Epipolar geometry: Nister's five-point algorithm in RANSAC (P8, P14, P21) and the three-view check (P7, fig. 3).
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/camera.h"
#include "geometry/measurement.h"
#include "geometry/pose.h"

namespace edgeslam {

struct RelativePose {
  bool found = false;
  // Translation of unit length. Where a rotation alone explains the matches, that rotation and no translation.
  Pose second_T_first;
  std::vector<char> inliers;  // one a correspondence
  int inlier_count = 0;
  // Median over the inliers of the angle [rad] between the rays that remains after the rotation is taken away: near
  // zero for a rotation alone or too little parallax.
  double parallax = 0;
  // Share of the correspondences that a rotation alone explains within the threshold (1: rotation only).
  double rotation_only_share = 0;
};

// Relative pose from matching unit bearings (same size). `threshold` is the epipolar error [rad] for an inlier: how far
// the two bearings together must turn to meet the epipolar constraint. Same seed, same result. Not found: fewer than 8
// matches or inliers, or a rotation alone explains over 90 % of the matches (then rotation, inliers and parallax are
// that rotation's). It tells nothing of two-fold solutions: the caller judges the structure.
RelativePose relativePose(const std::vector<Eigen::Vector3d>& first, const std::vector<Eigen::Vector3d>& second,
                          double threshold, std::uint64_t seed);

// Rotation second_R_first that best aligns matching unit bearings (Horn/Kabsch, robustified by trimming), and its
// median remaining angle [rad].
struct RelativeRotation {
  Eigen::Quaterniond rotation;
  double median_error = 0;
};
RelativeRotation relativeRotation(const std::vector<Eigen::Vector3d>& first,
                                  const std::vector<Eigen::Vector3d>& second);

// P7: deviation, whitened by the middle measurement, of the middle view's pixel from where the other two views'
// epipolar lines cross in it. Where they cross at less than 2 degrees, the larger of the (Mahalanobis) distances to
// each line is taken instead; a view without a baseline to the middle one predicts its own bearing. Infinite where the
// lines cross behind the camera. Poses are camera to world. `middle` is the measurement in the middle view; the other
// two pixels are taken as exact, so for an edge point, whose place along the edge is not known, they err by as much as
// they slid.
double threeViewError(const Camera& camera, const Pose& world_T_first, const Pose& world_T_middle,
                      const Pose& world_T_last, const Eigen::Vector2d& first_pixel, const Measurement& middle,
                      const Eigen::Vector2d& last_pixel);

}  // namespace edgeslam
