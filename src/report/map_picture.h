// A picture of a saved map from above, for people.
#pragma once

#include <opencv2/core/mat.hpp>

#include "map/map.h"

namespace edgeslam {

// CV_8UC3 (BGR): x of the world to the right and z up, which is ahead of where the camera began. Points are dark, lines
// orange, the way of the keyframes blue with a dot each and a larger one for the first. Worlds are beside each other,
// each as large as fits, with its number, its grid and how wide a square of that is [map units]; of more than 12 those
// with most keyframes.
cv::Mat drawMapFromAbove(const Map& map);

}  // namespace edgeslam
