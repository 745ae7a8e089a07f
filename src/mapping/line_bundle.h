// Lines of the map in a bundle adjustment (P19): what a line is known by are the ends of the straight edges that
// keyframes see it as. It stands for the points on it, whose depths would else absorb what their tracks err, and bend
// space.
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "adjustment/bundle_adjustment.h"
#include "geometry/camera.h"
#include "map/map.h"
#include "mapping/line_options.h"

namespace edgeslam {

// Adds both ends of a view of line `line` from camera `camera`, as they count in the problem.
void addEnds(const SeenEdge& edge, int camera, int line, BundleProblem& problem);

// Points, corner-like ones aside, by the placed line that most of the given keyframes which see them on lines see them
// on.
std::map<PointId, LineId> pointsOnLines(const Map& map, const std::vector<KeyframeId>& keyframes);

// What of a bundle problem is about lines.
struct LinesInBundle {
  std::vector<LineId> lines;                // by index in the problem
  std::map<PointId, LineId> line_of_point;  // points that the lines stand for
};

// Adds the placed lines that some keyframes see, with all views of them; `camera_of`: the index of a keyframe in the
// problem, which it is added to where it is not there.
LinesInBundle addLines(const std::vector<KeyframeId>& keyframes, const Map& map,
                       const std::function<int(KeyframeId)>& camera_of, BundleProblem& problem);

// Lines and the points on them as they were found, keyframes' poses being there already. Lines that their views
// contradict are dissolved; true where there were any.
bool readLines(const Camera& camera, const LineOptions& options, const BundleProblem& problem,
               const BundleResult& result, const LinesInBundle& in_bundle, Map& map);

}  // namespace edgeslam
