// What a long run's poses are beside the truth: how far off they are, and whether their covariance says so.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/uncertainty.h"

namespace edgeslam {

// A pose that was called good, and where the camera was.
struct JudgedPose {
  int world = 0;
  Pose world_T_camera;                              // [map units]
  Matrix6d world_covariance = Matrix6d::Zero();     // of its right-hand update [translation; rotation]
  Eigen::Vector3d truth = Eigen::Vector3d::Zero();  // of the camera's centre [m]
};

// A pass over a sequence.
struct SoakTruth {
  std::int64_t pass = 0;
  std::string sequence;
  std::size_t poses = 0;    // in the world that most of them are in
  double error_m = 0;       // root mean square, after a similarity alignment
  double beyond_share = 0;  // of the poses, farther off than 99 in 100 should be by their covariance ...
  double wrong_share = 0;   // ... and by over a tenth of the extent of where the camera was
};

// The world is laid on the truth by the poses that most agree on, so that a few wrong ones do not hide by moving the
// rest. Fewer than 10 poses say nothing: all is 0.
SoakTruth judgeByTruth(const std::vector<JudgedPose>& poses);

// Heading and one line a pass over a sequence.
std::string truthHeading();
std::string truthLine(const SoakTruth& truth);

// What is wrong or did not stay as it was, a line each: over 1 % of a sequence's poses are called good and are wrong;
// or its error, the median of the odd passes, is in the last third of the passes over 1.5 times and 1 cm of that in the
// first third. Fewer than 4 passes tell nothing of the latter.
std::vector<std::string> truthProblems(const std::vector<SoakTruth>& passes);

}  // namespace edgeslam
