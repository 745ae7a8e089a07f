// PNG, read and written by libpng.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string_view>
#include <vector>

namespace edgeslam {

// Grey values of a PNG of any kind: CV_8U, or CV_16U where it has 16 bits a channel. Colour becomes grey by libpng's
// own weights of 0.299, 0.587 and 0.114, transparency is left out. Empty where the file is damaged, cut off, or of over
// 2^26 pixels; throws std::bad_alloc where there is no memory for the image.
cv::Mat decodePng(std::string_view bytes);

// How much work is put into it. Where no other reason counts: quick.
enum class PngEffort {
  huffman,  // each pixel's difference to its left neighbour, Huffman-coded
  quick,    // likewise, and runs of the same difference made short
  small,    // zlib's level 1 on the best of all differences
};

// `image`: CV_8U, one channel (grey) or three (blue, green, red); not empty. Throws std::bad_alloc.
std::vector<unsigned char> encodePng(const cv::Mat& image, PngEffort effort = PngEffort::quick);

}  // namespace edgeslam
