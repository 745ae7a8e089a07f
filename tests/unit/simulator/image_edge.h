// Where an edge really lies in a rendered image, for tests of the renderer.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core/mat.hpp>

namespace edgeslam {

inline double bilinear(const cv::Mat& image, const Eigen::Vector2d& pixel) {
  const int x = static_cast<int>(std::floor(pixel.x())), y = static_cast<int>(std::floor(pixel.y()));
  const double a = pixel.x() - x, b = pixel.y() - y;
  return (1 - b) * ((1 - a) * image.at<float>(y, x) + a * image.at<float>(y, x + 1)) +
         b * ((1 - a) * image.at<float>(y + 1, x) + a * image.at<float>(y + 1, x + 1));
}

// Distance along the unit `normal` from `pixel` to the step of grey values there, whose two sides are plain within
// `reach` [px]: the area under the profile tells it, however blurred the step is. `image` is CV_32F; the profile must
// lie inside.
inline double edgeOffset(const cv::Mat& image, const Eigen::Vector2d& pixel, const Eigen::Vector2d& normal,
                         double reach) {
  constexpr int steps = 200;
  const double low = bilinear(image, pixel - reach * normal), high = bilinear(image, pixel + reach * normal);
  double area = 0;
  for (int i = 0; i < steps; ++i) {
    area += (bilinear(image, pixel + reach * ((2 * i + 1.0) / steps - 1) * normal) - low) * 2 * reach / steps;
  }
  return reach - area / (high - low);
}

}  // namespace edgeslam
