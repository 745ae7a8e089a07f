// The rays of the simulated camera's pixels, undistorted once for all frames.
#pragma once

#include <vector>

#include "geometry/camera.h"

namespace edgeslam {

// Undistorted ray (u, v, 1) through each pixel's centre and its derivative by the pixel, row by row.
struct RayTable {
  int width = 0, height = 0;          // [px]
  std::vector<float> u, v;            // [1]
  std::vector<float> u_by_x, u_by_y;  // [1/px]
  std::vector<float> v_by_x, v_by_y;
};

// Throws InputError where a pixel sees no ray in front of the camera, or the distortion cannot be inverted there.
RayTable makeRayTable(const Camera& camera);

}  // namespace edgeslam
