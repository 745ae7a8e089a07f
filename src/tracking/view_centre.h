// Where the view of a map is centred that is only localised in: at the keyframe that the camera is nearest to. Mapping
// gives another view as soon as that is another keyframe.
#pragma once

#include "map/map_view.h"

namespace edgeslam {

// The keyframe of the view whose place and direction are nearest to the camera's; `current` as long as it is about as
// near, so that the view does not change back and forth. `scene_depth`: median distance of what is seen [map units].
KeyframeId nearestKeyframe(const MapView& view, const Pose& world_T_camera, double scene_depth, KeyframeId current);

}  // namespace edgeslam
