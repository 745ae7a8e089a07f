// Which line of the map a straight edge of a keyframe is a view of: the tracks that lie on it tell, as they lay on
// edges of keyframes before; else the line that projects onto it.
#pragma once

#include "geometry/camera.h"
#include "map/map.h"
#include "mapping/line_options.h"

namespace edgeslam {

// Finds the line of each straight edge of a keyframe, or begins a new one.
void associateLines(const Camera& camera, const LineOptions& options, KeyframeId keyframe, Map& map);

}  // namespace edgeslam
