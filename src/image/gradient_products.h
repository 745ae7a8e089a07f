// The grey values' gradient over a window, as products of its components summed up: what a structure tensor is made of.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace edgeslam {

// Sums of the products of twice the gradient's components, by differences of the neighbours: right minus left, lower
// minus upper; at the image's border the missing neighbour is the border pixel itself [grey^2/4 px^2].
struct GradientProducts {
  int64_t xx = 0;
  int64_t xy = 0;
  int64_t yy = 0;
  int count = 0;  // of pixels
};

// Sums over the pixels of `window`, which lies in `grey` (CV_8U).
GradientProducts gradientProducts(const cv::Mat& grey, const cv::Rect& window);

// What gradientProducts gives, one pixel after the other.
GradientProducts gradientProductsReference(const cv::Mat& grey, const cv::Rect& window);

}  // namespace edgeslam
