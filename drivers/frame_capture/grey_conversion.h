// A driver's buffer to 8 bits of grey, in one pass and without any work on colour.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "drivers/frame_capture/pixel_format.h"

namespace edgeslam {

constexpr int largest_image_side = 16384;  // [px]

struct BufferLayout {
  PixelFormat format = PixelFormat::grey;
  int width = 0;           // [px]
  int height = 0;          // [px]
  std::size_t stride = 0;  // bytes from a row to the next; 0: rows follow each other without padding
};

// Decodes motion-JPEG; holds the decoder's memory from frame to frame.
class JpegDecoder {
 public:
  JpegDecoder();
  ~JpegDecoder();
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;

  // The brightness of a JPEG image of exactly width x height pixels to `grey` (CV_8U of that size, rows may be padded).
  // Frames without Huffman tables, as cameras send them, have the usual ones. Returns what is wrong with it, or an
  // empty text; `grey` is then undefined. Whatever the bytes are, memory and time are bounded by the size.
  std::string decode(const std::uint8_t* data, std::size_t size, cv::Mat& grey);

 private:
  void* decoder_;
};

// Writes `grey` (CV_8U, width x height; made so where it is not) from a buffer of `size` bytes. The upper 8 of a
// pixel's 10, 12 or 16 bits are kept; samples of 10 and 12 bits beyond their range are white. Returns what is wrong
// with the buffer, or an empty text: shorter than the brightness needs, an impossible layout, a broken JPEG.
std::string convertToGrey(const BufferLayout& layout, const std::uint8_t* data, std::size_t size, JpegDecoder& jpeg,
                          cv::Mat& grey);

}  // namespace edgeslam
