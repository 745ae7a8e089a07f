// What another decoder makes of an image.
#pragma once

#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

namespace edgeslam {

inline cv::Mat asOpenCvReads(const std::string& bytes) {
  const std::vector<unsigned char> copy(bytes.begin(), bytes.end());
  return cv::imdecode(copy, cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
}

}  // namespace edgeslam
