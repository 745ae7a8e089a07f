// Motion-JPEG as cameras send it. A recording is decoded as the camera was, so that both give the same pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace edgeslam {

// A frame's file as a camera sent it; shared, never changed.
using CameraJpeg = std::shared_ptr<const std::vector<unsigned char>>;

// Decodes motion-JPEG; holds the decoder's memory from frame to frame.
class JpegDecoder {
 public:
  JpegDecoder();
  ~JpegDecoder();
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;
  JpegDecoder(JpegDecoder&&) = delete;
  JpegDecoder& operator=(JpegDecoder&&) = delete;

  // The brightness of a JPEG image of exactly width x height pixels to `grey` (CV_8U of that size, rows may be padded).
  // Frames without Huffman tables, as cameras send them, have the usual ones. Returns what is wrong with it, or an
  // empty text; `grey` is then undefined. Whatever the bytes are, memory and time are bounded by the size.
  std::string decode(const std::uint8_t* data, std::size_t size, cv::Mat& grey);

 private:
  void* decoder_;
};

}  // namespace edgeslam
