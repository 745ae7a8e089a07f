// P16: camera pose from 3D-2D correspondences by EPnP (Lepetit et al. 2009) in RANSAC.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/camera.h"
#include "geometry/pose.h"

namespace edgeslam {

struct ResectioningResult {
  bool found = false;
  Pose camera_T_world;
  std::vector<char> inliers;
  int inlier_count = 0;
};

// `points` in the world frame, `bearings` unit in the camera frame, same size; `threshold` [rad] for an inlier;
// `iterations` bounds RANSAC's. Same seed, same result. Not found: fewer than 6 correspondences or inliers, or inliers
// all on one line.
ResectioningResult resection(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3d>& bearings,
                             double threshold, std::uint64_t seed, int iterations = 200);

}  // namespace edgeslam
