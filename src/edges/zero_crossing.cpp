#include "edges/zero_crossing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace edgeslam {
namespace {

// Least mean slope, as a share of the plane's slope: it falls under this only where a second edge reaches into the
// window.
constexpr float kLeastSlopeShare = 0.5F;

constexpr float kLeastAgreement = 0.7F;  // cosine between the plane's gradient and the normal
constexpr float kNoEdge = std::numeric_limits<float>::quiet_NaN();

// Sums over the window; those of the columns reach one pixel further to the left and right.
template <int radius>
struct WindowSums {
  static constexpr int kSide = 2 * radius + 1;
  static constexpr int kLanes = (kSide + 2 + 3) / 4 * 4;  // whole vectors; the last ones are read but not used
  std::array<int, kLanes> columns{};
  std::array<int, kSide + 2> rows{};
  int positive = 0;

  WindowSums(const cv::Mat& dog, int x, int y) {
    for (int dy = -radius - 1; dy <= radius + 1; ++dy) {
      const int16_t* row = dog.ptr<int16_t>(y + dy) + x - radius - 1;
      int sum = 0;
      for (int i = 1; i <= kSide; ++i) sum += row[i];
      rows[static_cast<size_t>(dy + radius + 1)] = sum;
      if (std::abs(dy) > radius) continue;
      for (int i = 0; i < kSide + 2; ++i) columns[static_cast<size_t>(i)] += row[i];
      for (int i = 1; i <= kSide; ++i) positive += row[i] > 0 ? 1 : 0;
    }
  }
};

// Slope of the least-squares line through the sums of parallel lines (the plane's slope in one direction), times the
// window's sum of squared coordinates.
template <int radius, typename Sums>
int moment(const Sums& sums) {
  int total = 0;
  for (int i = -radius; i <= radius; ++i) total += i * sums[static_cast<size_t>(i + radius + 1)];
  return total;
}

// Change of the window's sum as the window moves by two pixels.
template <int radius, typename Sums>
int changeOfSum(const Sums& sums) {
  constexpr size_t kLast = 2 * radius + 2;
  return sums[kLast] + sums[kLast - 1] - sums[0] - sums[1];
}

template <int radius>
float fit(const cv::Mat& dog, int x, int y, const Eigen::Vector2f& normal, double sign_balance) {
  constexpr int kSide = 2 * radius + 1;
  constexpr int kCount = kSide * kSide;
  constexpr int kSquares = kSide * kSide * radius * (radius + 1) / 3;
  const WindowSums<radius> sums(dog, x, y);
  if (std::abs(2 * sums.positive - kCount) > sign_balance * kCount) return kNoEdge;
  const Eigen::Vector2f slope =
      Eigen::Vector2f(static_cast<float>(moment<radius>(sums.columns)), static_cast<float>(moment<radius>(sums.rows))) /
      static_cast<float>(kSquares);
  const float rise = slope.dot(normal);
  if (!(rise > 0) || rise * rise < kLeastAgreement * kLeastAgreement * slope.squaredNorm()) return kNoEdge;

  int total = 0;
  for (int i = 1; i <= kSide; ++i) total += sums.columns[static_cast<size_t>(i)];
  // The DoG bends away from the plane within the window. Its sum vanishes where the window is centred on the edge, so
  // the distance follows from the slope of that sum; the plane's own zero would be drawn to the pixel's centre.
  const Eigen::Vector2f change(static_cast<float>(changeOfSum<radius>(sums.columns)),
                               static_cast<float>(changeOfSum<radius>(sums.rows)));
  const float slope_of_sum = std::max(0.5F * change.dot(normal), kLeastSlopeShare * rise * kCount);
  return -static_cast<float>(total) / slope_of_sum;
}

}  // namespace

float distanceToZero(const cv::Mat& dog, int x, int y, const Eigen::Vector2f& normal, int radius, double sign_balance) {
  switch (radius) {
    case 1:
      return fit<1>(dog, x, y, normal, sign_balance);
    case 2:
      return fit<2>(dog, x, y, normal, sign_balance);
    case 3:
      return fit<3>(dog, x, y, normal, sign_balance);
    case kLargestFitRadius:
      return fit<kLargestFitRadius>(dog, x, y, normal, sign_balance);
    default:
      return kNoEdge;
  }
}

}  // namespace edgeslam
