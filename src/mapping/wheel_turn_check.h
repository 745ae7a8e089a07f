// Whether camera and wheels turn alike. Where they do not, throughout, the focal length or the odometry's turn is
// wrong, and no adjustment makes up for that.
#pragma once

#include <string>

#include "map/map.h"
#include "wheels/wheel_motion.h"

namespace edgeslam {

// What is amiss in a world, in words that a user understands; empty where nothing is, or too little was turned.
std::string turnContradiction(const WheelOptions& wheels, const Map& map, int world);

}  // namespace edgeslam
