#include "places/explained_edges.h"

#include <algorithm>
#include <cmath>

namespace edgeslam {
namespace {

// The map's points in view, by square cells of the image as large as the distance that matters.
class Cells {
 public:
  Cells(const cv::Size& size, double side, const VisiblePoints& visible)
      : side_(static_cast<float>(std::max(1.0, side))),
        columns_(indexOf(static_cast<float>(size.width)) + 1),
        rows_(indexOf(static_cast<float>(size.height)) + 1),
        cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
    for (const VisiblePoint& point : visible) {
      const int column = std::clamp(indexOf(point.pixel.x()), 0, columns_ - 1);
      const int row = std::clamp(indexOf(point.pixel.y()), 0, rows_ - 1);
      cells_[cellOf(row, column)].push_back(&point);
    }
  }

  // True where any point of the cells around the pixel satisfies the condition.
  template <typename Condition>
  bool anyAround(const Eigen::Vector2f& pixel, Condition condition) const {
    const int column = indexOf(pixel.x()), row = indexOf(pixel.y());
    for (int y = std::max(0, row - 1); y <= std::min(rows_ - 1, row + 1); ++y) {
      for (int x = std::max(0, column - 1); x <= std::min(columns_ - 1, column + 1); ++x) {
        for (const VisiblePoint* point : cells_[cellOf(y, x)]) {
          if (condition(*point)) return true;
        }
      }
    }
    return false;
  }

 private:
  std::size_t cellOf(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }
  int indexOf(float coordinate) const { return static_cast<int>(std::floor(coordinate / side_)); }

  float side_;
  int columns_, rows_;
  std::vector<std::vector<const VisiblePoint*>> cells_;
};

}  // namespace

double explainedShare(const EdgeMap& edges, const VisiblePoints& visible, const ExplainedEdgesOptions& options) {
  if (edges.points.empty()) return 0;
  const Cells cells(edges.index.size(), options.distance, visible);
  const auto across = static_cast<float>(options.across), distance = static_cast<float>(options.distance);
  const auto least_dot = static_cast<float>(options.least_dot);
  std::size_t explained = 0;
  for (const EdgePoint& edge : edges.points) {
    explained += cells.anyAround(edge.pixel, [&](const VisiblePoint& point) {
      const Eigen::Vector2f apart = edge.pixel - point.pixel;
      return std::abs(apart.dot(point.normal)) < across && apart.squaredNorm() < distance * distance &&
             point.normal.dot(edge.normal) > least_dot;
    });
  }
  return static_cast<double>(explained) / static_cast<double>(edges.points.size());
}

}  // namespace edgeslam
