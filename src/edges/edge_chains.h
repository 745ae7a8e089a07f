// P3: edge points joined along the edge into chains (after Tarrio and Pedre, ICCV 2015, section 3).
#pragma once

#include "edges/edge_detection.h"

namespace edgeslam {

// Joins `workspace.pixels` into the chains of `edges`. On entry `edges.index` holds for each pixel of the image the
// index of its edge pixel, or -1; those that it does not name are left out. On return it names the chains' points.
// Two points are joined where each is the other's best continuation along the edge, so a chain ends at a junction.
// Chains of fewer than `shortest_chain` points are dropped. Walking along `next`, the brighter side lies on the left
// hand as seen on the screen. A closed chain's last point is joined to its first.
void joinChains(int shortest_chain, EdgeWorkspace& workspace, EdgeMap& edges);

}  // namespace edgeslam
