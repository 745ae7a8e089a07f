#include "edges/edge_detection.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "edges/edge_chains.h"
#include "edges/thinning.h"
#include "edges/zero_crossing.h"

namespace edgeslam {
namespace {

// The points stay in the list, but the index does not name them: no edge.
void hide(const CameraMask& mask, const std::vector<EdgePixel>& points, cv::Mat& index) {
  CV_Assert(mask.hidden.size() == index.size());
  for (const EdgePixel& point : points) {
    if (mask.hidden.at<uint8_t>(point.cell) != 0) index.at<int>(point.cell) = -1;
  }
}

}  // namespace

EdgeMap makeEdgeMap(const cv::Size& size) {
  EdgeMap edges;
  edges.points.reserve(mostEdgePoints(size));
  edges.index = cv::Mat(size, CV_32S, cv::Scalar(-1));
  return edges;
}

void detectEdges(const cv::Mat& grey, const EdgeOptions& options, EdgeWorkspace& workspace, EdgeMap& edges,
                 const CameraMask* mask) {
  CV_Assert(grey.empty() || grey.type() == CV_8U);
  CV_Assert(options.sigma > 0 && options.sigma_ratio > 1 && options.plane_fit_radius >= 1 &&
            options.plane_fit_radius <= largest_fit_radius);
  if (grey.empty()) {
    edges = {};
    return;
  }
  differenceOfGaussians(grey, options.sigma, options.sigma_ratio, workspace.blurs);
  const size_t most = mostEdgePoints(grey.size());
  workspace.ahead.reserve(most);
  workspace.behind.reserve(most);
  edges.points.reserve(most);
  findEdgePixels(workspace.blurs, options, workspace.pixels, edges.index);
  if (mask) hide(*mask, workspace.pixels.points, edges.index);
  thin(workspace.pixels.points, edges.index);
  joinChains(options.shortest_chain, workspace, edges);
}

EdgeMap detectEdges(const cv::Mat& grey, const EdgeOptions& options, const CameraMask* mask) {
  EdgeWorkspace workspace;
  EdgeMap edges;
  detectEdges(grey, options, workspace, edges, mask);
  return edges;
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
