#include "edges/structure_tensor.h"

#include <algorithm>
#include <cmath>

#include "image/gradient_products.h"

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

StructureTensor structureTensor(const cv::Mat& grey, const Eigen::Vector2f& pixel, int window) {
  const cv::Rect inside = windowInside(grey.size(), pixel, window);
  if (inside.empty()) return {};
  const GradientProducts sums = gradientProducts(grey, inside);
  const double scale = 0.25 / sums.count;
  return decompose(scale * static_cast<double>(sums.xx), scale * static_cast<double>(sums.xy),
                   scale * static_cast<double>(sums.yy));
}

}  // namespace edgeslam
