// How the map lies to the earth: gravity's direction in it, metres a unit, and the unit's biases, from the poses of the
// keyframes as they are (Campos, Montiel, Tardos, Inertial-Only Optimization for Visual-Inertial Initialization, 2020;
// without speeds, which drop out of what three keyframes in a row say: adjustment/bundle_inertia.h).
#pragma once

#include <optional>
#include <string>

#include "map/map.h"

namespace edgeslam {

// Why the scale is not known, where there are keyframes enough.
constexpr const char* speed_changes_too_little = "inertia: the scale is not known yet; the speed must change more";

// A scale that wheels know is held so well, as a share of it: they measure ways, where inertia has but their changes.
constexpr double held_scale_sigma = 1e-3;

struct InertialAlignmentOptions {
  double largest_scale_sigma = 0.05;  // the scale is known when its standard deviation is below this share of it
  int fewest_keyframes = 8;           // in a row, over ...
  double least_seconds = 2.5;         // ... so long
  int most_keyframes = 60;            // the latest so many are looked at
};

struct InertialAlignmentEstimate {
  InertialAlignment alignment;
  std::optional<InertialAlignment> rough;  // where it is not known, but there is something to begin with
  std::string lacking;                     // why it is not known yet, in words that a user understands; empty: it is
};

// Of a world. `so_far`: what was found earlier, from which scale and gravity are improved and the biases follow; the
// gyroscope's bias is found before the others. `wheels`: the scale by wheels beneath the camera, which
// is held where these know it.
InertialAlignmentEstimate estimateInertialAlignment(const InertialUnit& unit, const InertialAlignmentOptions& options,
                                                    const Map& map, int world, const InertialAlignment& so_far,
                                                    const WheelScale& wheels);

}  // namespace edgeslam
