// Straight pieces of image edges: what a straight line of space may be seen as. The pieces are found along the chains,
// so that edges which merely meet are never one; and on the detected edges rather than on the tracked points, which
// walk as their patches are renewed.
#pragma once

#include <Eigen/Core>
#include <memory_resource>
#include <vector>

#include "edges/edge_detection.h"
#include "geometry/camera.h"

namespace edgeslam {

struct StraightEdgeOptions {
  bool enabled = true;
  double least_length = 25;    // [px]
  double largest_offset = 1;   // of an edge point from the straight line through its piece's ends [px]
  double largest_bend = 0.35;  // how far a parabola through the piece would leave the straight line [px]
  double end_margin = 3;       // edges are rounded where they meet others: so much of each end is left out [px]
};

struct StraightEdge {
  // Its ends, on the straight line that fits it best; going from the first to the second, the brighter side is on the
  // left as seen on the screen.
  Eigen::Vector2d from, to;                  // [px]
  Eigen::Vector3d from_bearing, to_bearing;  // unit, camera frame
  int first_point = 0, end_point = 0;        // of EdgeMap::points
};

using StraightEdges = std::pmr::vector<StraightEdge>;

// In the order of the chains. Straight is what is straight in space: the lens's distortion is undone.
StraightEdges straightEdges(const Camera& camera, const EdgeMap& edges, const StraightEdgeOptions& options,
                            std::pmr::memory_resource* memory = std::pmr::get_default_resource());

// Index of the straight edge that a point of the edge map is on, or -1; nearer to an end than `margin` points it is on
// none.
int straightEdgeOf(const StraightEdges& straight, int edge_point, int margin);

}  // namespace edgeslam
