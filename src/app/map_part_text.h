// Parts of a map as they are named on the command line.
#pragma once

#include <string>
#include <utility>

#include "map/map_cropping.h"

namespace edgeslam {

// "-1:2.5,:,0:" is a box: from the least to the most of x, y and z [map units]; what is left out is not bounded. Throws
// InputError.
MapBox parseMapBox(const std::string& text);

// "12:40", or "12" alone. Throws InputError.
std::pair<KeyframeId, KeyframeId> parseKeyframeRange(const std::string& text);

}  // namespace edgeslam
