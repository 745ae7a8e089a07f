// What tracking gets to see of the map: all keyframe poses, and the points that the camera may meet where it is now:
// those of the latest keyframes and of older ones that looked at the same place (map reuse, design, section 5).
#pragma once

#include "map/map.h"
#include "map/map_view.h"

namespace edgeslam {

struct ViewOptions {
  int latest_keyframes = 8;
  int near_keyframes = 12;        // older ones, most
  double largest_turn_deg = 40;   // between their directions of view and the latest one's
  double largest_distance = 0.7;  // between their centres and the latest one's, as a share of its median depth
  // Points are found again by how the keyframe nearest to the centre saw them; otherwise by how the latest one did,
  // which is where the camera is while the map grows.
  bool nearest_sources = false;
};

// Of the world of `centre`, the keyframe near which the camera is: the latest one, or the one against which it was
// found again.
MapView viewOfMap(const Map& map, KeyframeId centre, const ViewOptions& options);

}  // namespace edgeslam
