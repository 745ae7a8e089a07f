// Absolute trajectory error and relative pose error (Sturm et al. 2012), as the TUM benchmark's tool and evo give them.
#pragma once

#include <vector>

#include "dataset/trajectory.h"
#include "geometry/similarity.h"

namespace edgeslam {

enum class Alignment { similarity, rigid, none };

struct ErrorStatistics {
  double rmse = 0, mean = 0, median = 0, standard_deviation = 0, min = 0, max = 0;
};

struct AbsoluteError {
  int pairs = 0;
  Similarity reference_T_estimate;       // the alignment used
  ErrorStatistics translation;           // [m], or the reference's unit
  std::vector<std::int64_t> times_ns;    // of each pair's estimate
  std::vector<double> errors;            // of each pair
  std::vector<Eigen::Vector3d> aligned;  // estimated positions after alignment
};

struct RelativeError {
  int pairs = 0;
  ErrorStatistics translation;  // [m]
  ErrorStatistics rotation;     // [rad]
};

// Nearest association within `tolerance_s`: each reference pose is used at most once. Throws InputError where fewer
// than 3 pairs (1 without alignment) are found.
AbsoluteError absoluteError(const Trajectory& estimate, const Trajectory& reference, Alignment alignment,
                            double tolerance_s = 0.02);

// Over pairs of poses `delta_s` apart, the estimate scaled as `alignment` says.
RelativeError relativeError(const Trajectory& estimate, const Trajectory& reference, Alignment alignment,
                            double delta_s = 1.0, double tolerance_s = 0.02);

}  // namespace edgeslam
