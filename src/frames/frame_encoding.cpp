#include "frames/frame_encoding.h"

#include <opencv2/imgcodecs.hpp>

namespace edgeslam {

bool encodeFrame(const cv::Mat& grey, std::vector<unsigned char>& png) {
  try {
    return cv::imencode(".png", grey, png, {cv::IMWRITE_PNG_STRATEGY, cv::IMWRITE_PNG_STRATEGY_HUFFMAN_ONLY});
  } catch (const cv::Exception&) {  // an assertion on what libpng, which had no memory, answered
    return false;
  }
}

}  // namespace edgeslam
