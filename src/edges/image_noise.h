// How much of the grey gradients is the image's noise: in dim light, where a sensor amplifies, an edge as straight as
// any would pass for corner-like otherwise.
#pragma once

#include <opencv2/core/mat.hpp>

#include "geometry/camera_mask.h"

namespace edgeslam {

// Variance of a component of the grey gradient, by central differences, that the noise of `grey` (CV_8U) gives
// [grey^2/px^2]: as the median of its second differences along rows and columns has it, so that edges and what texture
// covers less than half of the image do not count, nor what `mask` hides. At most 32, the noise of 8 grey values; 0 of
// less than 3 x 3 pixels.
double gradientNoise(const cv::Mat& grey, const CameraMask* mask = nullptr);

}  // namespace edgeslam
