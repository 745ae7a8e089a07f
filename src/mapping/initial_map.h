// The map that an accepted initial structure gives, and the poses of all frames that led to it.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "map/map.h"
#include "mapping/initial_structure.h"

namespace edgeslam {

// Keyframe 0 is the first frame, in whose camera frame the world is; the structure's frames follow. Has the points that
// one of these sees and whose inverse depth is known better than to `largest_depth_sigma`, a share of it.
Map initialMap(const Camera& camera, const InitialFrames& frames, const InitialStructure& structure,
               double largest_depth_sigma);

// Frame index and keyframe0_T_camera of the first frame and those since, ascending; without those from before the last
// one that cannot be located.
std::vector<std::pair<std::int64_t, Pose>> posesOfInitialFrames(const Camera& camera, const InitialFrames& frames,
                                                                const InitialStructure& structure);

// Tells the map's keyframes how they moved as they were read, by the poses of the start's frames.
void tellMotion(const InitialFrames& frames, const std::vector<std::pair<std::int64_t, Pose>>& poses, Map& map);

}  // namespace edgeslam
