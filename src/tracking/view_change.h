// How the world moved from one view of the map to the next: corrections move it, and joining it to another world
// changes its unit.
#pragma once

#include <optional>

#include "geometry/similarity.h"
#include "map/map_view.h"

namespace edgeslam {

// By the latest keyframe that both views know. The scale is 1 within a world: what changes with drift is left to the
// next pose. Nothing where they share no keyframe.
std::optional<Similarity> newWorldSOldWorld(const MapView& old_view, const MapView& new_view);

}  // namespace edgeslam
