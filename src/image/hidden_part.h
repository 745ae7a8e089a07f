// A small image of which a part is not to be seen, as it shows what is masked.
#pragma once

#include <opencv2/core/mat.hpp>

namespace edgeslam {

// Which pixels of an image that is made as small as `size` are hidden: CV_8U, 255 where any of the pixel is under
// `hidden` (CV_8U, not 0 where hidden), else 0.
cv::Mat hiddenPart(const cv::Mat& hidden, const cv::Size& size);

// Puts the mean of what is seen around into the hidden part of `image` (CV_32F), weighted by a Gaussian [px], so that
// filters of that reach do not see a border there.
void fillHidden(const cv::Mat& hidden, double sigma, cv::Mat& image);

}  // namespace edgeslam
