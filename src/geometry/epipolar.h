// Relative pose of two views from their epipolar geometry: Nister's five-point algorithm in RANSAC (P8, P14, P21).
#pragma once

#include <cstdint>
#include <vector>

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

}  // namespace edgeslam
