// P27, first half: the drift that a loop shows is shared out over the keyframes between its ends, by a pose graph over
// Sim(3) (Strasdat et al. 2010): rotations, positions and the scale of each keyframe's surroundings. What an inertial
// unit or wheels know does not drift, and is kept: the scale, and which way is up. With both, four degrees of freedom
// remain.
#pragma once

#include <optional>
#include <vector>

#include "geometry/similarity.h"

namespace edgeslam {

struct PoseGraphNode {
  Similarity world_S_node;  // camera coordinates, in the node's own scale, to the world's
  bool fixed = false;
};

// A measured relation of two nodes.
struct PoseGraphEdge {
  int from = 0, to = 0;  // indices of nodes
  Similarity from_S_to;  // from_S_to = from_S_world * world_S_to
  double weight = 1;     // of the residual; over 0
};

struct PoseGraph {
  std::vector<PoseGraphNode> nodes;
  std::vector<PoseGraphEdge> edges;
  double length = 1;                  // an error in position by this counts as one in rotation by 1 rad [map units]
  bool keeps_scale = false;           // of the nodes
  std::optional<Eigen::Vector3d> up;  // the world's frame, unit: nodes turn about it alone
};

struct PoseGraphResult {
  bool usable = false;  // else the graph is as it was
  double initial_cost = 0, final_cost = 0;
  int iterations = 0;
};

// Minimises the weighted errors [rotation vector; translation / length; logarithm of the scale] of all edges, in place.
// At least one node must be fixed. Not usable where an index is out of range, a value not finite, a scale, weight or
// length not over 0, `up` not unit, or the solver failed.
PoseGraphResult optimisePoseGraph(PoseGraph& graph, int iterations);

}  // namespace edgeslam
