#include "frames/frame_encoding.h"

#include <new>

#include "image_formats/netpbm.h"
#include "image_formats/png.h"

namespace edgeslam {

bool encodeFrame(const cv::Mat& grey, FrameCode code, std::vector<unsigned char>& file) {
  try {
    file = code == FrameCode::packed ? encodePng(grey, PngEffort::huffman) : encodePgm(grey);
  } catch (const std::bad_alloc&) {
    return false;
  }
  return true;
}

const char* fileEnding(FrameCode code) { return code == FrameCode::packed ? ".png" : ".pgm"; }

}  // namespace edgeslam
