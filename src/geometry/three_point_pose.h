// Camera pose from three points and their bearings (P3P): Grunert's quartic, as reviewed by Haralick et al. 1994.
#pragma once

#include <array>

#include "geometry/pose.h"

namespace edgeslam {

struct ThreePointPoses {
  int count = 0;
  std::array<Pose, 4> camera_T_world;
};

// `points` in the world frame, `bearings` unit in the camera frame. Up to four poses; none where the points lie on a
// line or the bearings do not fit any. Does not allocate.
ThreePointPoses posesFromThreePoints(const std::array<Eigen::Vector3d, 3>& points,
                                     const std::array<Eigen::Vector3d, 3>& bearings);

}  // namespace edgeslam
