// A driver's buffer to 8 bits of grey, in one pass and without any work on colour.
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>

#include "drivers/frame_capture/pixel_format.h"
#include "image_formats/jpeg_decoder.h"

namespace edgeslam {

constexpr int largest_image_side = 16384;  // [px]

struct BufferLayout {
  PixelFormat format = PixelFormat::grey;
  int width = 0;           // [px]
  int height = 0;          // [px]
  std::size_t stride = 0;  // bytes from a row to the next; 0: rows follow each other without padding
};

// Writes `grey` (CV_8U, width x height; made so where it is not) from a buffer of `size` bytes. The upper 8 of a
// pixel's 10, 12 or 16 bits are kept; samples of 10 and 12 bits beyond their range are white. Returns what is wrong
// with the buffer, or an empty text: shorter than the brightness needs, an impossible layout, a broken JPEG.
std::string convertToGrey(const BufferLayout& layout, const std::uint8_t* data, std::size_t size, JpegDecoder& jpeg,
                          cv::Mat& grey);

}  // namespace edgeslam
