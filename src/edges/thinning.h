// P2: edges one pixel wide.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "edges/edge_pixels.h"

namespace edgeslam {

// Keeps, where two points lie next to each other across the same edge, the one nearer to its pixel's centre: `index`,
// as findEdgePixels gave it, no longer names the other.
void thin(const std::vector<EdgePixel>& points, cv::Mat& index);

}  // namespace edgeslam
