// What an inertial unit felt between keyframes, where its clock turns out to differ otherwise from the camera's: other
// samples lie between them.
#pragma once

#include <vector>

#include "map/map.h"

namespace edgeslam {

// Measures links between keyframes anew that were not with the unit's offset. `samples`: what was measured lately,
// times ascend. A link for which they have not all come yet is left as it is; one that they do not tell any more is
// dropped.
void takeLinksAnew(const InertialUnit& unit, const std::vector<InertialSample>& samples, Map& map);

}  // namespace edgeslam
