// P28: map points of one image edge, joined in their order, so that the map shows edges as lines.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipeline/run_result.h"

namespace edgeslam {

// Indices into `points`: every finite point is in exactly one line, in the order along its chain; a point that no
// neighbour joins is a line of one. Two neighbours are joined where neither their gap in order nor their distance,
// relative to their depth as seen from the nearest of `cameras` and to that gap, is far above what is usual in this
// map. Lines come in order of chain.
std::vector<std::vector<int>> joinChains(const std::vector<MapPointRecord>& points,
                                         const std::vector<Eigen::Vector3d>& cameras);

}  // namespace edgeslam
