#include "edges/structure_tensor.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace edgeslam {
namespace {

// Eigenvalues and first eigenvector of [xx xy; xy yy] in closed form.
StructureTensor decompose(double xx, double xy, double yy) {
  const double mean = 0.5 * (xx + yy);
  const double half_difference = 0.5 * (xx - yy);
  const double radius = std::sqrt(half_difference * half_difference + xy * xy);
  StructureTensor tensor;
  tensor.l1 = static_cast<float>(mean + radius);
  tensor.l2 = static_cast<float>(std::max(0.0, mean - radius));
  // Of the two forms of the eigenvector, the one in which nothing cancels.
  const Eigen::Vector2d direction = half_difference >= 0 ? Eigen::Vector2d(radius + half_difference, xy)
                                                         : Eigen::Vector2d(xy, radius - half_difference);
  const double length = direction.norm();
  if (length > 0) tensor.direction = (direction / length).cast<float>();
  return tensor;
}

// The part of the window around `pixel` that lies in an image of this size; empty where none does.
cv::Rect windowInside(const cv::Size& size, const Eigen::Vector2f& pixel, int window) {
  const float reach = static_cast<float>(window);
  if (!pixel.allFinite() || window < 1 || pixel.minCoeff() < -reach ||
      pixel.x() > static_cast<float>(size.width) + reach || pixel.y() > static_cast<float>(size.height) + reach) {
    return {};
  }
  const auto x = static_cast<int>(std::lround(pixel.x()));
  const auto y = static_cast<int>(std::lround(pixel.y()));
  return cv::Rect(x - window / 2, y - window / 2, window, window) & cv::Rect(cv::Point(0, 0), size);
}

}  // namespace

GradientProducts gradientProducts(const cv::Mat& grey, const Eigen::Vector2f& pixel, int window) {
  const cv::Rect inside = windowInside(grey.size(), pixel, window);
  GradientProducts products;
  products.count = inside.area();
  for (int y = inside.y; y < inside.y + inside.height; ++y) {
    const auto* row = grey.ptr<uint8_t>(y);
    const auto* above = grey.ptr<uint8_t>(std::max(y - 1, 0));
    const auto* below = grey.ptr<uint8_t>(std::min(y + 1, grey.rows - 1));
    for (int x = inside.x; x < inside.x + inside.width; ++x) {
      const int along_x = row[std::min(x + 1, grey.cols - 1)] - row[std::max(x - 1, 0)];
      const int along_y = below[x] - above[x];
      products.xx += along_x * along_x;
      products.xy += along_x * along_y;
      products.yy += along_y * along_y;
    }
  }
  return products;
}

StructureTensor structureTensor(const GradientProducts& products) {
  if (products.count == 0) return {};
  const double scale = 0.25 / products.count;
  return decompose(scale * static_cast<double>(products.xx), scale * static_cast<double>(products.xy),
                   scale * static_cast<double>(products.yy));
}

StructureTensor structureTensor(const cv::Mat& grey, const Eigen::Vector2f& pixel, int window) {
  return structureTensor(gradientProducts(grey, pixel, window));
}

}  // namespace edgeslam
