// Keeps points apart: a set of points that tells whether a new one would come too near to any of them.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/types.hpp>
#include <vector>

namespace edgeslam {

class PointSpacing {
 public:
  // For points in an image of this size, none nearer to another than `distance` [px].
  PointSpacing(const cv::Size& size, double distance);

  bool isFree(const Eigen::Vector2f& pixel) const;
  void add(const Eigen::Vector2f& pixel);

 private:
  cv::Point bucketOf(const Eigen::Vector2f& pixel) const;
  size_t indexOf(int column, int row) const;

  float squared_distance_;
  float side_;  // of a bucket, at least the distance [px]
  cv::Size grid_;
  std::vector<std::vector<Eigen::Vector2f>> buckets_;
};

}  // namespace edgeslam
