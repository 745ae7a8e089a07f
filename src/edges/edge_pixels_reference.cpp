#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "edges/edge_pixels.h"
#include "edges/zero_crossing.h"

namespace edgeslam {
namespace {

// True where the DoG changes sign towards a 4-neighbour that is hardly nearer to zero, and the gradient is steep
// enough.
bool mayBeEdge(const DifferenceOfGaussians& images, int x, int y, int least_difference) {
  const auto narrow = [&](int dx, int dy) { return static_cast<int>(images.narrow.ptr<uint16_t>(y + dy)[x + dx]); };
  const auto dog = [&](int dx, int dy) { return static_cast<int>(images.dog.ptr<int16_t>(y + dy)[x + dx]); };
  const int steeper = std::max(std::abs(narrow(1, 0) - narrow(-1, 0)), std::abs(narrow(0, 1) - narrow(0, -1)));
  const int lowest = std::min(std::min(dog(-1, 0), dog(1, 0)), std::min(dog(0, -1), dog(0, 1)));
  const int highest = std::max(std::max(dog(-1, 0), dog(1, 0)), std::max(dog(0, -1), dog(0, 1)));
  const int here = dog(0, 0);
  const int bar = (here >> 2) - here;
  return steeper >= least_difference && (here > 0 ? lowest <= bar : highest >= bar);
}

// The blurred grey values' gradient at a pixel [grey/px].
Eigen::Vector2f greyGradient(const cv::Mat& narrow, int x, int y) {
  const auto* row = narrow.ptr<uint16_t>(y);
  constexpr float half_gain = 0.5F / blur_scale;
  return {half_gain * static_cast<float>(row[x + 1] - row[x - 1]),
          half_gain * static_cast<float>(narrow.ptr<uint16_t>(y + 1)[x] - narrow.ptr<uint16_t>(y - 1)[x])};
}

// Adds the edge point of pixel (x, y), if there is one and room for it.
void addZeroCrossing(const DifferenceOfGaussians& images, int x, int y, const EdgeOptions& options, size_t most,
                     std::vector<EdgePixel>& points, cv::Mat& index) {
  const Eigen::Vector2f gradient = greyGradient(images.narrow, x, y);
  const auto threshold = static_cast<float>(options.gradient_threshold);
  const float squared = gradient.squaredNorm();
  if (squared < threshold * threshold || points.size() == most) return;
  // The grey gradient gives the normal: the DoG's own is thrice as noisy.
  const float steepness = std::sqrt(squared);
  // By component: on 32-bit ARM, Eigen's division of vectors is not right to the last bit.
  const Eigen::Vector2f normal(gradient.x() / steepness, gradient.y() / steepness);
  const bool along_row = std::abs(normal.x()) >= std::abs(normal.y());
  const float offset = offsetOfZero(images.dog, x, y, along_row);
  if (std::isnan(offset)) return;
  if (!isEdgeLike(images.dog, x, y, normal, options.plane_fit_radius, options.sign_balance)) return;
  EdgePixel point;
  point.pixel = Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) +
                offset * (along_row ? normal.x() : normal.y()) * normal;
  point.normal = normal;
  point.gradient = steepness;
  point.offset = offset;
  point.cell = {x, y};
  index.at<int>(y, x) = static_cast<int>(points.size());
  points.push_back(point);
}

}  // namespace

void prepareEdgePixels(const cv::Size& size, EdgePixels& pixels, cv::Mat& index) {
  pixels.points.clear();
  pixels.points.reserve(mostEdgePoints(size));
  index.create(size, CV_32S);
  for (int y = 0; y < size.height; ++y) std::fill_n(index.ptr<int>(y), size.width, -1);
}

int16_t leastDifference(const EdgeOptions& options) {
  // The larger component of a gradient is at least its length over sqrt 2.
  return static_cast<int16_t>(std::clamp(2.0 * blur_scale * options.gradient_threshold * 0.7, 1.0, 32767.0));
}

void findEdgePixelsReference(const DifferenceOfGaussians& images, const EdgeOptions& options, EdgePixels& pixels,
                             cv::Mat& index) {
  const cv::Size size = images.dog.size();
  prepareEdgePixels(size, pixels, index);
  const int margin = edgeMargin(options);
  const int least_difference = leastDifference(options);
  for (int y = margin; y < size.height - margin; ++y) {
    for (int x = margin; x < size.width - margin; ++x) {
      if (!mayBeEdge(images, x, y, least_difference)) continue;
      addZeroCrossing(images, x, y, options, mostEdgePoints(size), pixels.points, index);
    }
  }
}

}  // namespace edgeslam
