#include "frames/frame_encoding.h"

#include <new>

#include "image_formats/png.h"

namespace edgeslam {

bool encodeFrame(const cv::Mat& grey, FrameCode code, std::vector<unsigned char>& png) {
  try {
    png = encodePng(grey, code == FrameCode::packed ? PngEffort::huffman : PngEffort::stored);
  } catch (const std::bad_alloc&) {
    return false;
  }
  return true;
}

}  // namespace edgeslam
