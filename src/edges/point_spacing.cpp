#include "edges/point_spacing.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {

PointSpacing::PointSpacing(const cv::Size& size, double distance) { start(size, distance, 0); }

void PointSpacing::start(const cv::Size& size, double distance, size_t most_points) {
  squared_distance_ = static_cast<float>(distance * distance);
  side_ = static_cast<float>(std::max(distance, 4.0));
  grid_ = {static_cast<int>(static_cast<float>(size.width) / side_) + 1,
           static_cast<int>(static_cast<float>(size.height) / side_) + 1};
  buckets_.assign(static_cast<size_t>(grid_.area()), -1);
  entries_.clear();
  entries_.reserve(most_points);
}

// Points outside the image go to the nearest bucket; clamping brings no two points further apart.
cv::Point PointSpacing::bucketOf(const Eigen::Vector2f& pixel) const {
  const float x = std::clamp(pixel.x() / side_, 0.0F, static_cast<float>(grid_.width - 1));
  const float y = std::clamp(pixel.y() / side_, 0.0F, static_cast<float>(grid_.height - 1));
  return {static_cast<int>(x), static_cast<int>(y)};
}

size_t PointSpacing::indexOf(int column, int row) const {
  const int index = row * grid_.width + column;
  return static_cast<size_t>(index);
}

bool PointSpacing::isFree(const Eigen::Vector2f& pixel) const {
  const cv::Point bucket = bucketOf(pixel);
  for (int row = std::max(bucket.y - 1, 0); row <= std::min(bucket.y + 1, grid_.height - 1); ++row) {
    for (int column = std::max(bucket.x - 1, 0); column <= std::min(bucket.x + 1, grid_.width - 1); ++column) {
      for (int i = buckets_[indexOf(column, row)]; i >= 0; i = entries_[static_cast<size_t>(i)].next) {
        if ((entries_[static_cast<size_t>(i)].pixel - pixel).squaredNorm() < squared_distance_) return false;
      }
    }
  }
  return true;
}

void PointSpacing::add(const Eigen::Vector2f& pixel) {
  if (!pixel.allFinite()) return;
  const cv::Point bucket = bucketOf(pixel);
  int& newest = buckets_[indexOf(bucket.x, bucket.y)];
  entries_.push_back({pixel, newest});
  newest = static_cast<int>(entries_.size()) - 1;
}

}  // namespace edgeslam
