// Keyframes that add nothing are taken out of the map, and the map stays within its bounds for any length of run
// (design, section 5: map reuse).
#pragma once

#include <vector>

#include "map/map.h"
#include "mapping/new_points.h"

namespace edgeslam {

struct CullingOptions {
  bool enabled = true;
  int recent_keyframes = 10;       // the latest so many stay
  int other_views = 10;            // a point that so many other keyframes see does not need this one ...
  double redundant_share = 0.9;    // ... and a keyframe that this share of its points does not need adds nothing
  int most_keyframes = 200;        // over either bound the keyframe goes that the fewest points need
  double most_megabytes = 120.0;   // of images, observations and points
  int small_world_keyframes = 15;  // before that, the smallest world that the camera is not in and that has no more
};

// Where a keyframe was that is no longer in the map: what it carried is carried by another one.
struct CulledKeyframe {
  KeyframeId id = -1;
  KeyframeId kept = -1;  // of the same world; -1: the whole world is gone
  Pose kept_T_culled;    // where nothing was kept, world_T_culled
  int world = 0;
};

// Memory that the map takes [bytes].
std::size_t memoryOf(const Map& map);

// Takes out what adds nothing, then what is over the bounds; never a world's first keyframe, which is its origin, nor
// the latest. Points that were hosted in a culled keyframe move to the first other one that sees them; a point that
// fewer than two keyframes see is gone.
std::vector<CulledKeyframe> cullKeyframes(const CullingOptions& options, Map& map, Candidates& candidates);

}  // namespace edgeslam
