// Straight edges as landmarks: lines of space, four unknowns each, that persist over the keyframes which see them. The
// points that lie on a line get their places from it.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/space_line.h"

namespace edgeslam {

using LineId = std::int64_t;

// One end of what a frame saw of a straight edge.
struct EdgeEnd {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();     // [px]
  Eigen::Vector3d bearing = Eigen::Vector3d::UnitZ();  // unit, camera frame of the row where it was measured
};

// A straight edge as a frame saw it. From the first end to the second the brighter side is on the left as seen on the
// screen, so that edges of opposite polarity are never the same.
struct SeenEdge {
  LineId line = -1;  // that it is a view of; -1: of none
  EdgeEnd from, to;
  double sigma = 0;  // across the edge, at each end [rad]
};

struct MapLine {
  LineId id = 0;
  int host = 0;               // a keyframe that sees it
  SpaceLine in_host;          // host camera frame [map units]; without meaning before it is placed
  bool is_placed = false;     // enough keyframes see it, and agree
  double begin = 0, end = 0;  // what was seen of it: along its direction from its point [map units]
  std::vector<int> seen_in;   // keyframes, ascending, the host among them
};

}  // namespace edgeslam
