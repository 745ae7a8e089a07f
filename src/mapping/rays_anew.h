// The rays of a map whose camera turns out to be another one: where its rows are read over another time, or its focal
// length is another one, the pixels that were measured are of other rays.
#pragma once

#include <vector>

#include "geometry/camera.h"
#include "map/map.h"

namespace edgeslam {

// Gives what these keyframes saw its rays anew, by `camera`, and the points that they host their places on these, as
// far away as they were.
void takeRaysAnew(const Camera& camera, const std::vector<KeyframeId>& keyframes, Map& map);

}  // namespace edgeslam
