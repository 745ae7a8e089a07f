// An image halved by a 5x5 Gaussian (1 4 6 4 1, both ways): a level of the pyramid from the finer one.
#pragma once

#include <opencv2/core/mat.hpp>

namespace edgeslam {

// Pixels that halve() may read outside of the finer image, on each side [px].
constexpr int halving_border = 24;

// The size of an image of this size when halved: rounded up.
inline cv::Size halfOf(const cv::Size& size) { return {(size.width + 1) / 2, (size.height + 1) / 2}; }

// Fills `coarser` (CV_8U, halfOf(finer's size), allocated) from `finer` (CV_8U), a view into an image with
// halving_border pixels around it, of which the two nearest count. Rounded to the nearest grey value.
void halve(const cv::Mat& finer, cv::Mat& coarser);

// What halve() gives, one pixel after the other.
void halveReference(const cv::Mat& finer, cv::Mat& coarser);

}  // namespace edgeslam
