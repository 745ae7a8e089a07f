#include "edges/thinning.h"

#include <cassert>
#include <cmath>
#include <cstddef>

namespace edgeslam {
namespace {

bool nearerToRows(const Eigen::Vector2f& normal) { return std::abs(normal.x()) >= std::abs(normal.y()); }

}  // namespace

void thin(const std::vector<EdgePixel>& points, cv::Mat& index) {
  assert(points.empty() || index.type() == CV_32S);
  const auto row_step = static_cast<std::ptrdiff_t>(index.step1());
  auto* entries = index.ptr<int>(0);
  for (const EdgePixel& point : points) {
    int& here = entries[point.cell.y * row_step + point.cell.x];
    const std::ptrdiff_t across = nearerToRows(point.normal) ? 1 : row_step;
    for (int* beside : {&here - across, &here + across}) {
      if (*beside < 0 || here < 0) continue;
      const EdgePixel& other = points[static_cast<size_t>(*beside)];
      // Where the edge turns from rows to columns, neighbours may follow each other along it.
      if (nearerToRows(point.normal) != nearerToRows(other.normal) &&
          std::abs(point.normal.dot(other.pixel - point.pixel)) > 0.5F) {
        continue;
      }
      (std::abs(point.offset) > std::abs(other.offset) ? here : *beside) = -1;
    }
  }
}

}  // namespace edgeslam
