// What tracks say along the lines that they lie on. They slide, so that over many keyframes they say nothing. From one
// keyframe to the next they slide little, and where few lines are in view that is what tells turning from moving past.
#pragma once

#include <functional>
#include <vector>

#include "adjustment/bundle_adjustment.h"
#include "geometry/camera.h"
#include "map/map.h"

namespace edgeslam {

// For each track that two consecutive keyframes see on the same one of the given placed lines: adds a point that is on
// the line where the first of them sees it, seen by the second one along the line only. `camera_of`: index of a
// keyframe in the problem, -1 if it is not there; keyframes that are both fixed learn nothing.
void addMotionAlongLines(const Camera& camera, const Map& map, const std::vector<LineId>& lines,
                         const std::function<int(KeyframeId)>& camera_of, BundleProblem& problem);

}  // namespace edgeslam
