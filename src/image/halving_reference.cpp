#include <cstdint>

#include "image/halving.h"

namespace edgeslam {

void halveReference(const cv::Mat& finer, cv::Mat& coarser) {
  CV_Assert(finer.type() == CV_8U && coarser.type() == CV_8U && coarser.size() == halfOf(finer.size()));
  const auto step = static_cast<std::ptrdiff_t>(finer.step[0]);
  for (int y = 0; y < coarser.rows; ++y) {
    const uint8_t* centre = finer.ptr<uint8_t>(2 * y);
    auto* row = coarser.ptr<uint8_t>(y);
    const auto column = [&](std::ptrdiff_t x) {
      return centre[x - 2 * step] + 4 * (centre[x - step] + centre[x + step]) + 6 * centre[x] + centre[x + 2 * step];
    };
    for (int x = 0; x < coarser.cols; ++x) {
      const std::ptrdiff_t at = 2 * x;
      const int sum = column(at - 2) + 4 * (column(at - 1) + column(at + 1)) + 6 * column(at) + column(at + 2);
      row[x] = static_cast<uint8_t>((sum + 128) >> 8);
    }
  }
}

}  // namespace edgeslam
