// Absolute trajectory error and relative pose error (Sturm et al. 2012), as the TUM benchmark's tool and evo give them.
#pragma once

#include <cstdint>
#include <vector>

#include "evaluation/trajectory.h"
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

// How much of the reference the estimate speaks of.
struct Coverage {
  double time_share = 0;  // of the reference's time span, gaps over three median steps of the estimate left out
  double pose_share = 0;  // of the reference's poses that have an estimated pose within the tolerance
  double pose_share_after_start = 0;  // likewise, from the first estimated pose on
  double start_s = 0;                 // from the reference's first pose to the estimate's first; negative if earlier
};

// Errors of positions. Poses are associated nearest first within `tolerance_s`, each used at most once. Throws
// InputError where fewer than 3 pairs (1 without alignment) are found. Both trajectories sorted by time.
AbsoluteError absoluteError(const Trajectory& estimate, const Trajectory& reference, Alignment alignment,
                            double tolerance_s = 0.02);

// Over pairs of estimated poses `delta_s` apart (each pose with the one nearest to `delta_s` later), against the motion
// between the reference poses nearest to them, within `tolerance_s`. The estimate is scaled as `alignment` says;
// nothing else of the alignment matters here. As in the TUM tool, a pose whose partner would be the last pose or lie
// beyond it has no pair; unlike there, neither has one whose partner would be itself. No pairs where the trajectory is
// too short. Throws InputError where `delta_s` is not above 0, or as absoluteError.
RelativeError relativeError(const Trajectory& estimate, const Trajectory& reference, Alignment alignment,
                            double delta_s = 1.0, double tolerance_s = 0.02);

// Throws InputError where either trajectory is empty or the tolerance is impossible.
Coverage coverage(const Trajectory& estimate, const Trajectory& reference, double tolerance_s = 0.02);

}  // namespace edgeslam
