// Binary PGM (P5) and PPM (P6).
#pragma once

#include <opencv2/core/mat.hpp>
#include <string_view>
#include <vector>

namespace edgeslam {

// Grey values (CV_8U) of the first image; values of another range than 0 to 255 are scaled to it. Colour becomes grey
// as 0.299 red + 0.587 green + 0.114 blue. Empty where it is damaged, cut off, or of over 2^26 pixels. Throws
// std::bad_alloc where there is no memory for the image.
cv::Mat decodeNetpbm(std::string_view bytes);

// `grey` (CV_8U) as PGM, which has its pixels as they are. Throws std::bad_alloc.
std::vector<unsigned char> encodePgm(const cv::Mat& grey);

}  // namespace edgeslam
