// The rotation alone between two views: what it leaves of the bearings' difference is parallax (P8, P13, P14).
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace edgeslam {

struct RelativeRotation {
  Eigen::Quaterniond rotation;  // second_R_first
  double median_error = 0;      // of the angles that remain between the bearings [rad]
};

// Rotation that best aligns matching unit bearings (same size), by Kabsch's method (1976), made robust by trimming. The
// identity for no matches.
RelativeRotation relativeRotation(const std::vector<Eigen::Vector3d>& first,
                                  const std::vector<Eigen::Vector3d>& second);

}  // namespace edgeslam
