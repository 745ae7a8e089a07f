// What a run said of its good poses at the time, and whether it was true.
#pragma once

#include <string>
#include <vector>

#include "evaluation/trajectory.h"

namespace edgeslam {

// A frame with a measured pose: tracking, recovered or relocalised.
struct MeasuredPose {
  int frame = 0;  // its row in frames.csv, from 0
  std::int64_t time_ns = 0;
  Pose map_T_camera;      // as given out at the time, map units
  Eigen::Vector3d sigma;  // stated standard deviations of the position along the camera's axes, map units
};

// From `result`/frames.csv. Throws std::runtime_error where a good frame lacks its pose or its sigmas, or a sigma is
// not above 0.
std::vector<MeasuredPose> readMeasuredPoses(const std::string& result);

struct Honesty {
  int poses = 0;
  double share_within = 0;      // of the poses whose error lies within the stated 99 % bound
  double normalised_error = 0;  // mean squared error over stated variance, per degree of freedom; 1 were exact
  double median_sigma = 0;      // of the position along the worst axis, map units
  double largest_error = 0;     // [m]
  std::vector<int> outside;     // frames beyond the bound
};

// The errors of positions against the ground truth, of which every pose must have one within 1 ms. What no camera can
// know (where the world lies, its scale) is taken out by one similarity that weighs each pose by what it claims,
// 1 / sigma^2: the early ones, near the map's origin, which claim most, fix it, and a wrong pose that claims little
// does not bend it. The bound is of the chi-square distribution with 3 degrees of freedom, errors along the camera's
// axes taken as independent, since correlations are not in the table.
Honesty honestyOf(const std::vector<MeasuredPose>& poses, const Trajectory& truth);

}  // namespace edgeslam
