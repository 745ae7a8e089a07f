#include "edges/edge_detection.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <opencv2/core.hpp>

#include "edges/edge_chains.h"
#include "edges/zero_crossing.h"
#include "image/gaussian_blur.h"

namespace edgeslam {
namespace {

struct DogImages {
  cv::Mat narrow;  // CV_16U, blurGrey's scale
  cv::Mat dog;     // CV_16S, narrower minus wider
};

DogImages differenceOfGaussians(const cv::Mat& grey, const EdgeOptions& options) {
  DogImages images;
  images.narrow = blurGrey(grey, options.sigma);
  const cv::Mat wide = blurFurther(images.narrow, options.sigma, options.sigma * options.sigma_ratio);
  cv::subtract(images.narrow, wide, images.dog, cv::noArray(), CV_16S);
  return images;
}

int16_t lesser(int16_t a, int16_t b) { return a < b ? a : b; }
int16_t greater(int16_t a, int16_t b) { return a > b ? a : b; }
int16_t difference(int16_t a, int16_t b) { return static_cast<int16_t>(a - b); }
int16_t magnitude(int16_t a) { return greater(a, static_cast<int16_t>(-a)); }

// Marks the pixels of row y between `begin` and `end` that may hold an edge: the DoG changes sign towards a 4-neighbour
// that is hardly nearer to zero, and the gradient is steep enough. 16-bit integers in a plain loop, which the compiler
// vectorises.
void markCandidates(const DogImages& images, int y, int begin, int end, int16_t least_difference,
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

struct RawEdges {
  std::vector<EdgePoint> points;  // row by row
  std::vector<cv::Point> cells;   // the pixel that each lies in
  std::vector<float> offsets;     // of each from its pixel's centre, along the image axis nearer to the normal [px]
  cv::Mat index;                  // as EdgeMap's
};

// Adds the edge point of pixel (x, y), if there is one.
void addZeroCrossing(const DogImages& images, int x, int y, const EdgeOptions& options, RawEdges& edges) {
  const Eigen::Vector2f gradient = greyGradient(images.narrow, x, y);
  const auto threshold = static_cast<float>(options.gradient_threshold);
  const float squared = gradient.squaredNorm();
  if (squared < threshold * threshold) return;
  // The grey gradient gives the normal: the DoG's own is thrice as noisy.
  const float steepness = std::sqrt(squared);
  const Eigen::Vector2f normal = gradient / steepness;
  const bool along_row = std::abs(normal.x()) >= std::abs(normal.y());
  const float offset = offsetOfZero(images.dog, x, y, along_row);
  if (std::isnan(offset)) return;
  if (!isEdgeLike(images.dog, x, y, normal, options.plane_fit_radius, options.sign_balance)) return;
  EdgePoint point;
  point.pixel = Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) +
                offset * (along_row ? normal.x() : normal.y()) * normal;
  point.normal = normal;
  point.gradient = steepness;
  edges.index.at<int>(y, x) = static_cast<int>(edges.points.size());
  edges.points.push_back(point);
  edges.cells.emplace_back(x, y);
  edges.offsets.push_back(offset);
}

RawEdges findZeroCrossings(const DogImages& images, const EdgeOptions& options) {
  RawEdges edges;
  edges.index = cv::Mat(images.dog.size(), CV_32S, cv::Scalar(-1));
  const int begin = options.plane_fit_radius + 2;
  const int end = images.dog.cols - begin;
  if (begin >= end) return edges;
  // The larger component of a gradient is at least its length over sqrt 2.
  const auto least_difference =
      static_cast<int16_t>(std::clamp(2.0 * kBlurScale * options.gradient_threshold * 0.7, 1.0, 32767.0));
  constexpr int kMarksPerWord = sizeof(uint64_t) / sizeof(int16_t);
  std::vector<int16_t> marks(static_cast<size_t>(images.dog.cols + kMarksPerWord));
  for (int y = begin; y < images.dog.rows - begin; ++y) {
    markCandidates(images, y, begin, end, least_difference, marks.data());
    for (int x = begin; x < end; x += kMarksPerWord) {
      uint64_t any = 0;
      std::memcpy(&any, &marks[static_cast<size_t>(x)], sizeof(any));
      if (any == 0) continue;
      for (int i = x; i < std::min(x + kMarksPerWord, end); ++i) {
        if (marks[static_cast<size_t>(i)]) addZeroCrossing(images, i, y, options, edges);
      }
    }
  }
  return edges;
}

bool nearerToRows(const Eigen::Vector2f& normal) { return std::abs(normal.x()) >= std::abs(normal.y()); }

// P2: of two points next to each other across the same edge, the one nearer to its pixel's centre stays.
void thin(RawEdges& edges) {
  for (size_t i = 0; i < edges.points.size(); ++i) {
    int& here = edges.index.at<int>(edges.cells[i]);
    const EdgePoint& point = edges.points[i];
    const cv::Point across = nearerToRows(point.normal) ? cv::Point(1, 0) : cv::Point(0, 1);
    for (const cv::Point& side : {-across, across}) {
      int& beside = edges.index.at<int>(edges.cells[i] + side);
      if (here < 0 || beside < 0) continue;
      const EdgePoint& other = edges.points[static_cast<size_t>(beside)];
      // Where the edge turns from rows to columns, neighbours may follow each other along it.
      if (nearerToRows(point.normal) != nearerToRows(other.normal) &&
          std::abs(point.normal.dot(other.pixel - point.pixel)) > 0.5F) {
        continue;
      }
      (std::abs(edges.offsets[i]) > std::abs(edges.offsets[static_cast<size_t>(beside)]) ? here : beside) = -1;
    }
  }
}

}  // namespace

EdgeMap detectEdges(const cv::Mat& grey, const EdgeOptions& options) {
  CV_Assert(grey.empty() || grey.type() == CV_8U);
  CV_Assert(options.sigma > 0 && options.sigma_ratio > 1 && options.plane_fit_radius >= 1 &&
            options.plane_fit_radius <= kLargestFitRadius);
  if (grey.empty()) return {};
  RawEdges edges = findZeroCrossings(differenceOfGaussians(grey, options), options);
  thin(edges);
  return joinChains(edges.points, edges.cells, edges.index, options.shortest_chain);
}

int nearestEdgePoint(const EdgeMap& edges, const Eigen::Vector2f& pixel, const Eigen::Vector2f& normal, float radius,
                     float least_dot) {
  const float reach = radius + 1;  // a point lies up to about 0.7 px from the centre of the pixel that holds it
  if (edges.index.empty() || !pixel.allFinite() || !(radius >= 0)) return -1;
  if (pixel.x() < -reach || pixel.y() < -reach || pixel.x() > static_cast<float>(edges.index.cols) + reach ||
      pixel.y() > static_cast<float>(edges.index.rows) + reach) {
    return -1;
  }
  const int left = std::max(0, static_cast<int>(std::floor(pixel.x() - reach)));
  const int top = std::max(0, static_cast<int>(std::floor(pixel.y() - reach)));
  const int right = std::min(edges.index.cols - 1, static_cast<int>(std::ceil(pixel.x() + reach)));
  const int bottom = std::min(edges.index.rows - 1, static_cast<int>(std::ceil(pixel.y() + reach)));
  int nearest = -1;
  float nearest_squared = radius * radius;
  for (int y = top; y <= bottom; ++y) {
    const auto* row = edges.index.ptr<int>(y);
    for (int x = left; x <= right; ++x) {
      if (row[x] < 0) continue;
      const EdgePoint& point = edges.points[static_cast<size_t>(row[x])];
      const float squared = (point.pixel - pixel).squaredNorm();
      if (squared > nearest_squared || (squared == nearest_squared && nearest >= 0)) continue;
      if (point.normal.dot(normal) < least_dot) continue;
      nearest = row[x];
      nearest_squared = squared;
    }
  }
  return nearest;
}

}  // namespace edgeslam
