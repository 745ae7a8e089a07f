// Decodes one image file to grey, telling apart what is whole from what was cut off.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

namespace edgeslam {

struct DecodedImage {
  cv::Mat grey;         // CV_8U; empty where `problem` is set
  std::string problem;  // with the path, why it could not be read
};

// PNG, JPEG, BMP, PBM to PPM, TIFF and WebP, told by how the file begins; 16-bit images are scaled to 8 bits. Stored
// orientation (EXIF) is ignored: pixels stay where the sensor has them. A truncated JPEG, which decoders fill up with
// grey, is a problem here, and so is one of over 2^26 pixels, by its header.
DecodedImage readGreyImage(const std::string& path);

// Why an image of `size` cannot follow those of `expected`, naming both; empty where they are the same or none is
// expected.
std::string sizeProblem(cv::Size size, cv::Size expected, const std::string& expected_by);

}  // namespace edgeslam
