// JPEG, read and written by libjpeg-turbo.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string_view>
#include <vector>

namespace edgeslam {

// Whether the file goes on to its end: decoders fill up with grey what was cut off.
bool jpegIsWhole(std::string_view bytes);

// Grey values (CV_8U) of a JPEG in YCbCr, RGB or grey; of YCbCr its Y, with no conversion. Damage within the compressed
// data is passed over, as every viewer does. Empty where the file cannot be decoded, is in other colours (CMYK), or is
// of over 2^26 pixels or 64 scans, which would cost seconds. Throws std::bad_alloc where there is no memory for the
// image.
cv::Mat decodeJpeg(std::string_view bytes);

// `image`: CV_8U, one channel (grey) or three (blue, green, red); not empty. `quality`: 1 to 100. Throws
// std::bad_alloc.
std::vector<unsigned char> encodeJpeg(const cv::Mat& image, int quality);

}  // namespace edgeslam
