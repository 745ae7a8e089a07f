// How the keyframes of a map see its lines.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/camera.h"
#include "map/map.h"

namespace edgeslam {

// The line that a keyframe sees a point on, or -1.
LineId lineOf(const Keyframe& keyframe, const PointObservation& seen);

// An end of a straight edge as a ray of the world.
struct WorldRay {
  Eigen::Vector3d origin, direction;  // unit
};

WorldRay worldRay(const Camera& camera, const Keyframe& keyframe, const EdgeEnd& end);

// A straight edge in the world frame: the plane through it and the camera, whose normal tells the brighter side, and
// the direction to its middle.
struct EdgePlane {
  Eigen::Vector3d centre, normal, middle;
};

EdgePlane edgePlane(const Camera& camera, const Keyframe& keyframe, const SeenEdge& edge);

// Normal of the plane through a line (world frame) and a place, on the side where an edge's is.
Eigen::Vector3d normalSeenFrom(const SpaceLine& line, const Eigen::Vector3d& centre);

// A part of a line: along its direction from its point [map units].
struct Extent {
  double begin = 0, end = 0;
};

// What an edge shows of a line; an empty one (end before begin) where an end does not lie on it.
Extent extentOf(const Camera& camera, const SpaceLine& line, const Keyframe& keyframe, const SeenEdge& edge);

// Renews what is known of the extent of a placed line.
void renewExtent(const Camera& camera, const Map& map, MapLine& line);

}  // namespace edgeslam
