// A line gets its place where enough keyframes see it from different sides and agree; until then its points are points
// and nothing else.
#pragma once

#include "geometry/camera.h"
#include "map/map.h"
#include "mapping/line_options.h"

namespace edgeslam {

// Places lines that can be by now. Those that are not placed and out of sight are forgotten.
void placeLines(const Camera& camera, const LineOptions& options, Map& map);

}  // namespace edgeslam
