#include "edges/zero_crossing.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace edgeslam {
namespace {

// The window's columns, summed; and its rows.
template <int radius>
struct WindowSums {
  static constexpr int window_side = 2 * radius + 1;
  std::array<int, window_side> columns{};
  std::array<int, window_side> rows{};
  int positive = 0;

  WindowSums(const cv::Mat& dog, int x, int y) {
    for (int j = 0; j < window_side; ++j) {
      const int16_t* row = dog.ptr<int16_t>(y + j - radius) + x - radius;
      for (int i = 0; i < window_side; ++i) {
        columns[static_cast<size_t>(i)] += row[i];
        rows[static_cast<size_t>(j)] += row[i];
        positive += row[i] > 0 ? 1 : 0;
      }
    }
  }
};

// The least-squares plane's slope in one direction, up to a factor that is the same for both.
template <int radius, typename Sums>
float slopeOf(const Sums& sums) {
  int moment = 0;
  int coordinate = -radius;
  for (const int sum : sums) moment += coordinate++ * sum;
  return static_cast<float>(moment);
}

template <int radius>
bool isEdgeLikeWithin(const cv::Mat& dog, int x, int y, const Eigen::Vector2f& normal, double sign_balance) {
  constexpr int window_pixels = (2 * radius + 1) * (2 * radius + 1);
  const WindowSums<radius> sums(dog, x, y);
  if (std::abs(2 * sums.positive - window_pixels) > sign_balance * window_pixels) return false;
  const Eigen::Vector2f slope(slopeOf<radius>(sums.columns), slopeOf<radius>(sums.rows));
  const float rise = slope.dot(normal);
  return rise > 0 && rise * rise >= least_slope_agreement * least_slope_agreement * slope.squaredNorm();
}

}  // namespace

float offsetOfZero(const cv::Mat& dog, int x, int y, bool along_row) {
  assert(dog.type() == CV_16S && x >= 1 && y >= 1 && x < dog.cols - 1 && y < dog.rows - 1);
  const auto across = static_cast<std::ptrdiff_t>(along_row ? 1 : dog.step1());
  const auto along = static_cast<std::ptrdiff_t>(along_row ? dog.step1() : 1);
  const int16_t* centre = dog.ptr<int16_t>(y) + x;
  // Smoothed along the edge. Between two pixels the DoG of an edge is nearly straight.
  const auto value = [&](std::ptrdiff_t step) {
    const int16_t* at = centre + step * across;
    return at[-along] + 2 * at[0] + at[along];
  };
  const int here = value(0);
  const int after = value(1);
  if ((here > 0) != (after > 0) && std::abs(here) <= std::abs(after)) {
    return static_cast<float>(here) / static_cast<float>(here - after);
  }
  const int before = value(-1);
  if ((here > 0) != (before > 0) && std::abs(here) < std::abs(before)) {
    return static_cast<float>(here) / static_cast<float>(before - here);
  }
  return std::numeric_limits<float>::quiet_NaN();
}

bool isEdgeLike(const cv::Mat& dog, int x, int y, const Eigen::Vector2f& normal, int radius, double sign_balance) {
  assert(dog.type() == CV_16S && x >= radius && y >= radius && x < dog.cols - radius && y < dog.rows - radius);
  switch (radius) {
    case 1:
      return isEdgeLikeWithin<1>(dog, x, y, normal, sign_balance);
    case 2:
      return isEdgeLikeWithin<2>(dog, x, y, normal, sign_balance);
    case 3:
      return isEdgeLikeWithin<3>(dog, x, y, normal, sign_balance);
    case 4:
      return isEdgeLikeWithin<4>(dog, x, y, normal, sign_balance);
    case 5:
      return isEdgeLikeWithin<5>(dog, x, y, normal, sign_balance);
    case 6:
      return isEdgeLikeWithin<6>(dog, x, y, normal, sign_balance);
    case largest_fit_radius:
      return isEdgeLikeWithin<largest_fit_radius>(dog, x, y, normal, sign_balance);
    default:
      return false;
  }
}

}  // namespace edgeslam
