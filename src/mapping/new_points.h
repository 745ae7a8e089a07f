// P17: tracks that have no depth yet become map points where two or more keyframes give them one; P7: what fails the
// three-view check does not.
#pragma once

#include <map>
#include <vector>

#include "geometry/camera.h"
#include "map/map.h"

namespace edgeslam {

struct NewPointOptions {
  double largest_depth_sigma = 0.15;  // standard deviation of the inverse depth, as a share of it
  double least_parallax_deg = 0.3;    // largest angle between two rays to the point [deg]
  double largest_error = 3.0;         // whitened reprojection error over all views
  double three_view_error = 4.0;      // whitened, P7
  int fewest_views = 2;               // keyframes that see the point, its host included
  // Share of the median distance of what its host sees: what seems to be nearer moves against the camera, and would
  // have all the say in where that is.
  double least_distance = 0.05;
  std::size_t fewest_of_scene = 20;  // points that tell this distance
};

// Keyframes that saw a track which is no map point, ascending: the first is its host.
using Candidates = std::map<PointId, std::vector<KeyframeId>>;

// Adds the latest keyframe's observations to the points they belong to, or to the candidates.
void associate(Map& map, Candidates& candidates);

// Triangulates the candidates seen by the latest keyframe; returns how many became map points.
int addNewPoints(const Camera& camera, const NewPointOptions& options, Map& map, Candidates& candidates);

}  // namespace edgeslam
