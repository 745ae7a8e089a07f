#include <algorithm>
#include <cassert>

#include "image/gradient_products.h"

namespace edgeslam {

GradientProducts gradientProductsReference(const cv::Mat& grey, const cv::Rect& window) {
  assert(grey.type() == CV_8U && (window & cv::Rect({}, grey.size())) == window);
  GradientProducts products;
  products.count = window.area();
  for (int y = window.y; y < window.y + window.height; ++y) {
    const auto* row = grey.ptr<uint8_t>(y);
    const auto* above = grey.ptr<uint8_t>(std::max(y - 1, 0));
    const auto* below = grey.ptr<uint8_t>(std::min(y + 1, grey.rows - 1));
    for (int x = window.x; x < window.x + window.width; ++x) {
      const int along_x = row[std::min(x + 1, grey.cols - 1)] - row[std::max(x - 1, 0)];
      const int along_y = below[x] - above[x];
      products.xx += along_x * along_x;
      products.xy += along_x * along_y;
      products.yy += along_y * along_y;
    }
  }
  return products;
}

}  // namespace edgeslam
