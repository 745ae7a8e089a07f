// Taking a keyframe out of a map: what other keyframes see as well stays where it is.
#pragma once

#include "map/map.h"

namespace edgeslam {

// Points and lines that were hosted in it move to the first other keyframe that sees them. A point that fewer than two
// keyframes see is gone then, and a line that none sees. The keyframe must be there.
void removeKeyframe(KeyframeId id, Map& map);

}  // namespace edgeslam
