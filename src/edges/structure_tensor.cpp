#include "edges/structure_tensor.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace edgeslam {
namespace {

// The mean of [xx xy; xy yy] and what its eigenvalues are made of [grey^2/px^2].
struct MeanProducts {
  double xy;
  double mean;             // of xx and yy, and of the eigenvalues
  double half_difference;  // of xx and yy
  double radius;           // half the difference of the eigenvalues
};

MeanProducts meanOf(const GradientProducts& sums) {
  const double scale = 0.25 / sums.count;
  const double xx = scale * static_cast<double>(sums.xx);
  const double xy = scale * static_cast<double>(sums.xy);
  const double yy = scale * static_cast<double>(sums.yy);
  const double half_difference = 0.5 * (xx - yy);
  return {xy, 0.5 * (xx + yy), half_difference, std::sqrt(half_difference * half_difference + xy * xy)};
}

Eigenvalues eigenvaluesOf(const MeanProducts& products) {
  return {static_cast<float>(products.mean + products.radius),
          static_cast<float>(std::max(0.0, products.mean - products.radius))};
}

// As std::lround, which is a call.
int nearestInteger(float value) {
  const int integer = static_cast<int>(value);
  const float rest = value - static_cast<float>(integer);
  return integer + (rest >= 0.5F ? 1 : 0) - (rest <= -0.5F ? 1 : 0);
}

// The part of the window around `pixel` that lies in an image of this size; empty where none does.
cv::Rect windowInside(const cv::Size& size, const Eigen::Vector2f& pixel, int window) {
  const float reach = static_cast<float>(window);
  if (!pixel.allFinite() || window < 1 || pixel.minCoeff() < -reach ||
      pixel.x() > static_cast<float>(size.width) + reach || pixel.y() > static_cast<float>(size.height) + reach) {
    return {};
  }
  const int x = nearestInteger(pixel.x());
  const int y = nearestInteger(pixel.y());
  return cv::Rect(x - window / 2, y - window / 2, window, window) & cv::Rect(cv::Point(0, 0), size);
}

}  // namespace

GradientProducts gradientProductsAround(const cv::Mat& grey, const Eigen::Vector2f& pixel, int window) {
  assert(window % 2 == 1);
  const cv::Rect inside = windowInside(grey.size(), pixel, window);
  return inside.empty() ? GradientProducts() : gradientProducts(grey, inside);
}

Eigenvalues eigenvalues(const GradientProducts& products) {
  return products.count == 0 ? Eigenvalues() : eigenvaluesOf(meanOf(products));
}

StructureTensor structureTensor(const GradientProducts& products) {
  if (products.count == 0) return {};
  const MeanProducts mean = meanOf(products);
  const Eigenvalues values = eigenvaluesOf(mean);
  StructureTensor tensor;
  tensor.l1 = values.l1;
  tensor.l2 = values.l2;
  // Of the two forms of the eigenvector, the one in which nothing cancels.
  const Eigen::Vector2d direction = mean.half_difference >= 0
                                        ? Eigen::Vector2d(mean.radius + mean.half_difference, mean.xy)
                                        : Eigen::Vector2d(mean.xy, mean.radius - mean.half_difference);
  const double length = direction.norm();
  if (length > 0) tensor.direction = (direction / length).cast<float>();
  return tensor;
}

StructureTensor structureTensor(const cv::Mat& grey, const Eigen::Vector2f& pixel, int window) {
  return structureTensor(gradientProductsAround(grey, pixel, window));
}

}  // namespace edgeslam
