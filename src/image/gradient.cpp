#include "image/gradient.h"

#include <algorithm>
#include <cstdint>

namespace edgeslam {

TwiceGradient twiceGradient(const cv::Mat& grey) {
  CV_Assert(grey.empty() || grey.type() == CV_8U);
  TwiceGradient gradient{cv::Mat(grey.size(), CV_16S), cv::Mat(grey.size(), CV_16S)};
  const int width = grey.cols;
  for (int y = 0; y < grey.rows; ++y) {
    const auto* row = grey.ptr<uint8_t>(y);
    const auto* above = grey.ptr<uint8_t>(std::max(y - 1, 0));
    const auto* below = grey.ptr<uint8_t>(std::min(y + 1, grey.rows - 1));
    auto* along_x = gradient.x.ptr<int16_t>(y);
    auto* along_y = gradient.y.ptr<int16_t>(y);
    for (int x = 0; x < width; ++x) along_y[x] = static_cast<int16_t>(below[x] - above[x]);
    for (int x = 1; x + 1 < width; ++x) along_x[x] = static_cast<int16_t>(row[x + 1] - row[x - 1]);
    along_x[0] = static_cast<int16_t>(row[std::min(1, width - 1)] - row[0]);
    along_x[width - 1] = static_cast<int16_t>(row[width - 1] - row[std::max(width - 2, 0)]);
  }
  return gradient;
}

}  // namespace edgeslam
