// What must hold of a map before the program works with it, wherever it comes from.
#pragma once

#include <string>

#include "geometry/camera.h"
#include "map/map.h"

namespace edgeslam {

// Much is kept by keyframe number, so numbers must not run away. At one keyframe a second this is half a year.
constexpr KeyframeId largest_keyframe_id = (1 << 24) - 1;
constexpr std::int64_t largest_count = 4'000'000'000'000'000'000;  // of frames, points and lines

// The first thing that is wrong with a camera, in words; empty where nothing is. Sizes are positive and bounded,
// numbers finite.
std::string cameraProblem(const Camera& camera);

// The first thing that is wrong with a map, in words that name keyframe and point. Numbers are finite, bearings,
// normals and rotations of unit length, images of the camera's size, measured pixels in the image or its pyramid's
// border, inverse depths positive. A point's host and all that it is seen in are in one world of the map and have an
// observation of it; the chain's keyframe may have been culled.
std::string mapProblem(const Camera& camera, const Map& map);

}  // namespace edgeslam
