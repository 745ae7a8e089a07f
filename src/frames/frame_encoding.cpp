#include "frames/frame_encoding.h"

#include <opencv2/imgcodecs.hpp>

namespace edgeslam {

bool encodeFrame(const cv::Mat& grey, FrameCode code, std::vector<unsigned char>& png) {
  const std::vector<int> packed{cv::IMWRITE_PNG_STRATEGY, cv::IMWRITE_PNG_STRATEGY_HUFFMAN_ONLY};
  const std::vector<int> stored{cv::IMWRITE_PNG_COMPRESSION, 0};
  try {
    return cv::imencode(".png", grey, png, code == FrameCode::packed ? packed : stored);
  } catch (const cv::Exception&) {  // an assertion on what libpng, which had no memory, answered
    return false;
  }
}

}  // namespace edgeslam
