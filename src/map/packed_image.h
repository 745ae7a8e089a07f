// A grey image in little memory, without loss: what its pixels differ from their neighbours' prediction by, compressed.
// Sources: M. J. Weinberger et al., "The LOCO-I Lossless Image Compression Algorithm", 2000, for the prediction;
// Zstandard for the rest.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace edgeslam {

struct PackedImage {
  cv::Size size;
  std::vector<unsigned char> bytes;
};

// `grey`: CV_8U, not empty. About a third to a half of its bytes for a camera's image.
PackedImage packed(const cv::Mat& grey);

// The same image as before. Throws std::bad_alloc where there is no memory, std::logic_error for what packed() did not
// make.
cv::Mat unpacked(const PackedImage& image);

}  // namespace edgeslam
