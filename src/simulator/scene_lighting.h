// Light in the simulator's scenes, computed once: lamps with shadows, and even light that corners and gaps get less of.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "simulator/scene.h"

namespace edgeslam {

// Irradiance on each rectangle: CV_32F, a grid of nodes from (s, t) = (0, 0) at the first to (1, 1) at the last entry,
// columns along s. A rectangle that emits has its emission at every node.
std::vector<cv::Mat> computeLight(const Scene& scene);

}  // namespace edgeslam
