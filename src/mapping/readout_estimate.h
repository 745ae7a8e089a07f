// What some keyframes say of how long their camera reads the rows of an image: with which readout their adjustment
// costs least.
#pragma once

#include <optional>
#include <vector>

#include "mapping/camera_trial.h"

namespace edgeslam {

// No row is read in more time than passes from one frame to the next, and no camera takes over 50 ms [s].
double longestReadout(const Map& map, const std::vector<KeyframeId>& keyframes);

// Readouts up to `longest_s` of either sign are tried. Nothing where there is no least cost.
std::optional<CameraEstimate> estimateReadout(const LookedAt& at, double longest_s);

}  // namespace edgeslam
