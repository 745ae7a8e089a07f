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

StructureTensor tensorOver(const TwiceGradient& gradient, const cv::Rect& window) {
  if (window.empty()) return {};
  int64_t xx = 0;
  int64_t xy = 0;
  int64_t yy = 0;
  for (int y = window.y; y < window.y + window.height; ++y) {
    const int16_t* along_x = gradient.x.ptr<int16_t>(y) + window.x;
    const int16_t* along_y = gradient.y.ptr<int16_t>(y) + window.x;
    int row_xx = 0;
    int row_xy = 0;
    int row_yy = 0;
    for (int i = 0; i < window.width; ++i) {
      row_xx += along_x[i] * along_x[i];
      row_xy += along_x[i] * along_y[i];
      row_yy += along_y[i] * along_y[i];
    }
    xx += row_xx;
    xy += row_xy;
    yy += row_yy;
  }
  const double scale = 0.25 / window.area();
  return decompose(scale * static_cast<double>(xx), scale * static_cast<double>(xy), scale * static_cast<double>(yy));
}

}  // namespace

StructureTensor structureTensor(const cv::Mat& grey, const Eigen::Vector2f& pixel, int window) {
  const cv::Rect inside = windowInside(grey.size(), pixel, window);
  if (inside.empty()) return {};
  // One pixel more on each side, for the differences.
  const cv::Rect surroundings = cv::Rect(inside.x - 1, inside.y - 1, inside.width + 2, inside.height + 2) &
                                cv::Rect(cv::Point(0, 0), grey.size());
  return tensorOver(twiceGradient(grey(surroundings)), inside - surroundings.tl());
}

StructureTensor structureTensor(const TwiceGradient& gradient, const Eigen::Vector2f& pixel, int window) {
  return tensorOver(gradient, windowInside(gradient.x.size(), pixel, window));
}

}  // namespace edgeslam
