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

// `points` in the world frame, `bearings` unit in the camera frame; `threshold` [rad] for an inlier. Same seed, same
// result.
ResectioningResult resection(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3d>& bearings,
                             double threshold, std::uint64_t seed, int iterations = 200);

}  // namespace edgeslam
