// How one world lies to another, from cameras whose pose is known in both: each alone may be wrong, but not several
// that say the same.
#pragma once

#include <optional>
#include <vector>

#include "geometry/similarity.h"

namespace edgeslam {

// A camera that was found in both.
struct FoundInBoth {
  Pose from_T_camera, to_T_camera;
  double distance = 1;  // of the scene that it sees, in the unit of `to`
};

struct WorldAlignmentOptions {
  int fewest = 3;               // cameras that must agree ...
  double share = 0.5;           // ... and this share of all: what repeats must not decide
  double turn_deg = 5;          // within which they agree [deg] ...
  double position = 0.15;       // ... and share of the scene's distance
  double least_baseline = 0.1;  // of two cameras that tell the scale: share of the scene's distance
  double largest_scale = 10;    // of the one unit in the other, or its inverse
  std::size_t most_paired = 100;
};

struct WorldAlignment {
  Similarity to_S_from;
  std::vector<std::size_t> agreeing;  // the cameras that say so, by their places
};

// `agreeing` gets the most cameras that say the same, also where these are too few and there is no alignment.
std::optional<WorldAlignment> alignWorlds(const std::vector<FoundInBoth>& cameras, const WorldAlignmentOptions& options,
                                          std::size_t& agreeing);

}  // namespace edgeslam
