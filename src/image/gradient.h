// Grey-value gradients by central differences, in integers.
#pragma once

#include <opencv2/core/mat.hpp>

namespace edgeslam {

// Twice the gradient of `grey` (CV_8U): right minus left neighbour, lower minus upper one; CV_16S [grey / 2 px].
// At the image's border the missing neighbour is the border pixel itself.
struct TwiceGradient {
  cv::Mat x;
  cv::Mat y;
};

TwiceGradient twiceGradient(const cv::Mat& grey);

}  // namespace edgeslam
