#include "edges/edge_pixels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "edges/zero_crossing.h"

namespace edgeslam {
namespace {

int16_t lesser(int16_t a, int16_t b) { return a < b ? a : b; }
int16_t greater(int16_t a, int16_t b) { return a > b ? a : b; }
int16_t difference(int16_t a, int16_t b) { return static_cast<int16_t>(a - b); }
int16_t magnitude(int16_t a) { return greater(a, static_cast<int16_t>(-a)); }

// Marks the pixels of row y between `begin` and `end` that may hold an edge: the DoG changes sign towards a 4-neighbour
// that is hardly nearer to zero, and the gradient is steep enough. 16-bit integers in a plain loop, which the compiler
// vectorises.
void markCandidates(const DifferenceOfGaussians& images, int y, int begin, int end, int16_t least_difference,
                    int16_t* __restrict marks) {
  const auto* narrow = images.narrow.ptr<int16_t>(y);
  const auto* narrow_above = images.narrow.ptr<int16_t>(y - 1);
  const auto* narrow_below = images.narrow.ptr<int16_t>(y + 1);
  const auto* dog = images.dog.ptr<int16_t>(y);
  const auto* dog_above = images.dog.ptr<int16_t>(y - 1);
  const auto* dog_below = images.dog.ptr<int16_t>(y + 1);
  for (int x = begin; x < end; ++x) {
    const int16_t along_x = magnitude(difference(narrow[x + 1], narrow[x - 1]));
    const int16_t along_y = magnitude(difference(narrow_below[x], narrow_above[x]));
    const int16_t lowest = lesser(lesser(dog[x - 1], dog[x + 1]), lesser(dog_above[x], dog_below[x]));
    const int16_t highest = greater(greater(dog[x - 1], dog[x + 1]), greater(dog_above[x], dog_below[x]));
    const auto bar = static_cast<int16_t>((dog[x] >> 2) - dog[x]);
    const int16_t falls = lowest <= bar ? 1 : 0;
    const int16_t rises = highest >= bar ? 1 : 0;
    const int16_t crosses = dog[x] > 0 ? falls : rises;
    marks[x] = greater(along_x, along_y) >= least_difference ? crosses : int16_t{0};
  }
}

// The blurred grey values' gradient at a pixel [grey/px].
Eigen::Vector2f greyGradient(const cv::Mat& narrow, int x, int y) {
  const auto* row = narrow.ptr<uint16_t>(y);
  constexpr float kScale = 0.5F / kBlurScale;
  return {kScale * static_cast<float>(row[x + 1] - row[x - 1]),
          kScale * static_cast<float>(narrow.ptr<uint16_t>(y + 1)[x] - narrow.ptr<uint16_t>(y - 1)[x])};
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
  const Eigen::Vector2f normal = gradient / steepness;
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

void findEdgePixels(const DifferenceOfGaussians& images, const EdgeOptions& options, EdgePixels& pixels,
                    cv::Mat& index) {
  const cv::Size size = images.dog.size();
  const size_t most = mostEdgePoints(size);
  pixels.points.clear();
  pixels.points.reserve(most);
  index.create(size, CV_32S);
  for (int y = 0; y < size.height; ++y) std::fill_n(index.ptr<int>(y), size.width, -1);
  const int begin = options.plane_fit_radius + 2;
  const int end = size.width - begin;
  if (begin >= end) return;
  // The larger component of a gradient is at least its length over sqrt 2.
  const auto least_difference =
      static_cast<int16_t>(std::clamp(2.0 * kBlurScale * options.gradient_threshold * 0.7, 1.0, 32767.0));
  constexpr int kMarksPerWord = sizeof(uint64_t) / sizeof(int16_t);
  std::vector<int16_t>& marks = pixels.marks;
  marks.resize(static_cast<size_t>(size.width + kMarksPerWord));
  for (int y = begin; y < size.height - begin; ++y) {
    markCandidates(images, y, begin, end, least_difference, marks.data());
    for (int x = begin; x < end; x += kMarksPerWord) {
      uint64_t any = 0;
      std::memcpy(&any, &marks[static_cast<size_t>(x)], sizeof(any));
      if (any == 0) continue;
      for (int i = x; i < std::min(x + kMarksPerWord, end); ++i) {
        if (marks[static_cast<size_t>(i)]) addZeroCrossing(images, i, y, options, most, pixels.points, index);
      }
    }
  }
}

}  // namespace edgeslam
