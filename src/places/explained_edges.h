// P22: how much of a frame the map explains. Where a bare scene repeats, a wrong pose finds all the points that it asks
// for, but leaves edges of the frame over.
#pragma once

#include <vector>

#include "edges/edge_detection.h"
#include "tracking/map_search.h"

namespace edgeslam {

struct ExplainedEdgesOptions {
  double across = 4;       // an edge point lies on a map point's edge within this distance across it [px] ...
  double distance = 30;    // ... this distance in all [px] ...
  double least_dot = 0.8;  // ... and with its normal, dot product
};

// Share of the frame's edge points that lie on an edge of the map's points in view; 0 without edges.
double explainedShare(const EdgeMap& edges, const VisiblePoints& visible, const ExplainedEdgesOptions& options);

}  // namespace edgeslam
