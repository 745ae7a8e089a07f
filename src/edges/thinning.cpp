#include "edges/thinning.h"

#include <cmath>

namespace edgeslam {
namespace {

bool nearerToRows(const Eigen::Vector2f& normal) { return std::abs(normal.x()) >= std::abs(normal.y()); }

}  // namespace

void thin(const std::vector<EdgePixel>& points, cv::Mat& index) {
  for (const EdgePixel& point : points) {
    int& here = index.at<int>(point.cell);
    const cv::Point across = nearerToRows(point.normal) ? cv::Point(1, 0) : cv::Point(0, 1);
    for (const cv::Point& side : {-across, across}) {
      int& beside = index.at<int>(point.cell + side);
      if (here < 0 || beside < 0) continue;
      const EdgePixel& other = points[static_cast<size_t>(beside)];
      // Where the edge turns from rows to columns, neighbours may follow each other along it.
      if (nearerToRows(point.normal) != nearerToRows(other.normal) &&
          std::abs(point.normal.dot(other.pixel - point.pixel)) > 0.5F) {
        continue;
      }
      (std::abs(point.offset) > std::abs(other.offset) ? here : beside) = -1;
    }
  }
}

}  // namespace edgeslam
