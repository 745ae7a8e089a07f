#include <array>
#include <cmath>
#include <limits>

#include "edges/edge_neighbours.h"

namespace edgeslam {
namespace {

// The best continuation of `point`, which `entry` of `index` names, among the three pixels ahead in `direction`, or -1.
int continuation(const std::vector<EdgePixel>& points, const cv::Mat& index, const EdgePixel& point, const int* entry,
                 const Eigen::Vector2f& direction) {
  const int straight = octant(direction);
  int best = -1;
  float least_cost = std::numeric_limits<float>::max();
  for (const int turn : {0, 1, 7}) {
    const int candidate = entry[stepTo((straight + turn) % 8, index)];
    if (candidate < 0) continue;
    const EdgePixel& other = points[static_cast<size_t>(candidate)];
    if (point.normal.dot(other.normal) < least_neighbour_agreement) continue;
    const Eigen::Vector2f difference = other.pixel - point.pixel;
    if (difference.dot(direction) <= 0) continue;
    // Symmetric in the two points, so that they mostly choose each other: nearness, and how far each lies off the
    // other's line.
    const float off_here = difference.dot(point.normal);
    const float off_there = difference.dot(other.normal);
    const float cost = difference.squaredNorm() + 4 * (off_here * off_here + off_there * off_there);
    if (cost < least_cost) {
      least_cost = cost;
      best = candidate;
    }
  }
  return best;
}

}  // namespace

int octant(const Eigen::Vector2f& direction) {
  const float x = std::abs(direction.x());
  const float y = std::abs(direction.y());
  const int sign_x = direction.x() > 0 ? 1 : -1;
  const int sign_y = direction.y() > 0 ? 1 : -1;
  const int dx = x > tan_of_half_octant * y ? sign_x : 0;
  const int dy = y > tan_of_half_octant * x ? sign_y : 0;
  constexpr std::array<int, 9> octant_of_entry = {5, 6, 7, 4, 0, 0, 3, 2, 1};
  const int entry = 3 * (dy + 1) + dx + 1;
  return octant_of_entry[static_cast<size_t>(entry)];
}

std::ptrdiff_t stepTo(int octant, const cv::Mat& index) {
  constexpr std::array<int, 8> column_steps = {1, 1, 0, -1, -1, -1, 0, 1};
  constexpr std::array<int, 8> row_steps = {0, 1, 1, 1, 0, -1, -1, -1};
  const auto at = static_cast<size_t>(octant);
  return row_steps[at] * static_cast<std::ptrdiff_t>(index.step1()) + column_steps[at];
}

void chooseNeighboursReference(const std::vector<EdgePixel>& points, const cv::Mat& index, std::vector<int>& ahead,
                               std::vector<int>& behind) {
  for (size_t i = 0; i < points.size(); ++i) {
    const EdgePixel& point = points[i];
    const int* entry = index.ptr<int>(point.cell.y) + point.cell.x;
    const bool is_named = *entry == static_cast<int>(i);
    // Along `ahead` the edge runs a quarter turn from its normal.
    const Eigen::Vector2f direction(-point.normal.y(), point.normal.x());
    ahead[i] = is_named ? continuation(points, index, point, entry, direction) : not_named;
    behind[i] = is_named ? continuation(points, index, point, entry, -direction) : not_named;
  }
}

void keepMutualReference(std::vector<int>& ahead, std::vector<int>& behind) {
  for (size_t i = 0; i < ahead.size(); ++i) {
    const int next = ahead[i];
    if (next >= 0 && behind[static_cast<size_t>(next)] != static_cast<int>(i)) ahead[i] = -1;
  }
  for (size_t i = 0; i < behind.size(); ++i) {
    const int previous = behind[i];
    if (previous >= 0 && ahead[static_cast<size_t>(previous)] != static_cast<int>(i)) behind[i] = -1;
  }
}

}  // namespace edgeslam
