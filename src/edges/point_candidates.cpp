#include "edges/point_candidates.h"

#include <algorithm>

namespace edgeslam {
namespace {

constexpr int normal_reach = 6;  // neighbours on each side over which a normal is averaged [points]

// Mean normal of an edge point and as many neighbours along the chain before as after it, so that a bend does not turn
// it. A third as noisy as the point's own, and free of the skew that central differences give the tensor on sharp
// edges.
Eigen::Vector2f normalAlongChain(const EdgeMap& edges, const EdgePoint& edge) {
  Eigen::Vector2f sum = edge.normal;
  int before = edge.previous;
  int after = edge.next;
  for (int step = 0; step < normal_reach && before >= 0 && after >= 0; ++step) {
    const EdgePoint& behind = edges.points[static_cast<size_t>(before)];
    const EdgePoint& ahead = edges.points[static_cast<size_t>(after)];
    sum += behind.normal + ahead.normal;
    before = behind.previous;
    after = ahead.next;
  }
  const float length = sum.norm();
  return length > 0 ? Eigen::Vector2f(sum / length) : edge.normal;
}

PointCandidate makeCandidate(const cv::Mat& grey, const EdgeMap& edges, const EdgePoint& edge,
                             const PointAccuracy& accuracy) {
  PointCandidate candidate;
  candidate.pixel = edge.pixel;
  candidate.chain = edge.chain;
  candidate.gradient = edge.gradient;
  candidate.products = gradientProductsAround(grey, edge.pixel, accuracy.options.tensor_window);
  const Eigenvalues values = eigenvalues(candidate.products);
  candidate.l2 = values.l2;
  candidate.corner = isCornerLike(values, accuracy);
  if (candidate.corner) {
    const Eigen::Vector2f direction = structureTensor(candidate.products).direction;
    candidate.normal = direction.dot(edge.normal) < 0 ? Eigen::Vector2f(-direction) : direction;
  } else {
    candidate.normal = normalAlongChain(edges, edge);
  }
  return candidate;
}

}  // namespace

void findPointCandidates(const cv::Mat& grey, const EdgeMap& edges, const PointSpacing& spacing,
                         const PointSpread& spread, const PointAccuracy& accuracy,
                         std::vector<PointCandidate>& candidates) {
  const auto border = static_cast<float>(spread.border);
  const float right = static_cast<float>(grey.cols - 1) - border;
  const float bottom = static_cast<float>(grey.rows - 1) - border;
  for (size_t i = 0; i < edges.points.size(); i += candidate_step) {
    const EdgePoint& edge = edges.points[i];
    const Eigen::Vector2f& pixel = edge.pixel;
    if (pixel.x() < border || pixel.y() < border || pixel.x() > right || pixel.y() > bottom) continue;
    if (spacing.isFree(pixel)) candidates.push_back(makeCandidate(grey, edges, edge, accuracy));
  }
}

}  // namespace edgeslam
