// Keeps points apart: a set of points that tells whether a new one would come too near to any of them.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/types.hpp>
#include <vector>

namespace edgeslam {

class PointSpacing {
 public:
  // For an image without pixels; start() comes before all else.
  PointSpacing() = default;
  // For points in an image of this size, none nearer to another than `distance` [px].
  PointSpacing(const cv::Size& size, double distance);

  // Forgets all points. Allocates only where more buckets or points are needed than before.
  void start(const cv::Size& size, double distance, size_t most_points);

  bool isFree(const Eigen::Vector2f& pixel) const;
  void add(const Eigen::Vector2f& pixel);

 private:
  struct Entry {
    Eigen::Vector2f pixel;
    int next;  // entry of the same bucket, or -1
  };

  cv::Point bucketOf(const Eigen::Vector2f& pixel) const;
  size_t indexOf(int column, int row) const;

  float squared_distance_ = 0;
  float side_ = 1;  // of a bucket, at least the distance [px]
  cv::Size grid_;
  std::vector<int> buckets_;  // the last entry of each, or -1
  std::vector<Entry> entries_;
};

}  // namespace edgeslam
