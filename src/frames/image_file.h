// Decodes one image file to grey, telling apart what is whole from what was cut off.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>

namespace edgeslam {

struct DecodedImage {
  cv::Mat grey;         // CV_8U; empty where `problem` is set
  std::string problem;  // why it could not be read, with the path of a file
};

// The size that an image must have, and who says so, as "camera.yaml says". An empty one is any size.
struct ExpectedSize {
  cv::Size size;
  std::string by;
};

// PNG, JPEG, and binary PGM and PPM, told by how the file begins; 16-bit images are scaled to 8 bits. Stored
// orientation (EXIF) is ignored: pixels stay where the sensor has them. A truncated JPEG, which decoders fill up with
// grey, is a problem here. So is, by its header alone, an image of another size than the one expected, of over 2^26
// pixels, and one that claims more pixels than can be in so small a file.
DecodedImage readGreyImage(const std::string& path, const ExpectedSize& expected = {});

// The same of an image file's bytes; `problem` without a path.
DecodedImage decodeGreyImage(std::string_view bytes, const ExpectedSize& expected = {});

// Why an image of `size` cannot follow those of `expected`, naming both; empty where they are the same or none is
// expected.
std::string sizeProblem(cv::Size size, cv::Size expected, const std::string& expected_by);

}  // namespace edgeslam
