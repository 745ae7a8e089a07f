// How far the camera can have come while it was lost, by how fast it moved before: what would have it farther away only
// looks like the place that it is taken for.
#pragma once

#include <string>

#include "map/map.h"
#include "map/worlds.h"

namespace edgeslam {

// Where the camera can be by now.
struct Reachable {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // world
  double distance = 0;                               // [map units]
  int world = 0;                                     // that both are of
};

// From the pose at which the camera was lost `seconds` ago: twice as far as the fastest motion between two keyframes of
// the map would have led, and never less than the farthest that two successive ones lie apart.
Reachable reachableFrom(const Map& map, const Pose& world_T_camera, double seconds, int world = 0);

// Why two worlds cannot be one, in words: between the last keyframe of the one and the next of the other the camera
// would have come farther than it can, by the motion in either. Empty where it can, or where time says nothing: maps of
// several runs.
std::string outOfReach(const Map& map, const WorldJoin& join);

}  // namespace edgeslam
