// P16: camera pose from 3D-2D correspondences by EPnP (Lepetit et al. 2009) in RANSAC.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <vector>

#include "geometry/camera.h"
#include "geometry/pose.h"

namespace edgeslam {

using Vectors3 = std::pmr::vector<Eigen::Vector3d>;

struct ResectioningResult {
  explicit ResectioningResult(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) : inliers(memory) {}

  bool found = false;
  Pose camera_T_world;
  std::pmr::vector<char> inliers;
  int inlier_count = 0;
};

// `points` in the world frame, `bearings` unit in the camera frame, same size; `threshold` [rad] for an inlier, less
// than a right angle; `iterations` bounds RANSAC's. Same seed, same result. Not found: fewer than 6 correspondences or
// inliers, or inliers all on one line.
ResectioningResult resection(const Vectors3& points, const Vectors3& bearings, double threshold, std::uint64_t seed,
                             int iterations = 200);

// Like resection(), without EPnP: least squares from the pose of the best sample, which P3P gives. Takes all memory
// from `memory`.
ResectioningResult resectionBySamples(const Vectors3& points, const Vectors3& bearings, double threshold,
                                      std::uint64_t seed, int iterations, std::pmr::memory_resource* memory);

}  // namespace edgeslam
