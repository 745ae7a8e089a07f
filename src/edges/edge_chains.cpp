#include "edges/edge_chains.h"

#include <array>
#include <cmath>
#include <limits>

namespace edgeslam {
namespace {

constexpr float kLeastAgreement = 0.6F;  // dot product of the normals of two neighbours along an edge

struct Links {
  std::vector<int> ahead;
  std::vector<int> behind;
};

struct Step {
  int dx;
  int dy;
};

// The eight neighbours in the order of their direction's angle.
constexpr std::array<Step, 8> kRing = {{{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

int octant(const Eigen::Vector2f& direction) {
  constexpr float kTanOfEighth = 0.41421356F;
  const float x = std::abs(direction.x());
  const float y = std::abs(direction.y());
  const int sign_x = direction.x() > 0 ? 1 : -1;
  const int sign_y = direction.y() > 0 ? 1 : -1;
  const int dx = x > kTanOfEighth * y ? sign_x : 0;
  const int dy = y > kTanOfEighth * x ? sign_y : 0;
  constexpr std::array<int, 9> kOctants = {5, 6, 7, 4, 0, 0, 3, 2, 1};
  const int entry = 3 * (dy + 1) + dx + 1;
  return kOctants[static_cast<size_t>(entry)];
}

// The best continuation of the point in pixel `cell` among the three pixels ahead in `direction`, or -1.
int continuation(const std::vector<EdgePoint>& points, const cv::Mat& index, const cv::Point& cell,
                 const Eigen::Vector2f& direction) {
  const EdgePoint& point = points[static_cast<size_t>(index.at<int>(cell))];
  const int straight = octant(direction);
  int best = -1;
  float least_cost = std::numeric_limits<float>::max();
  for (const int turn : {0, 1, 7}) {
    const Step& step = kRing[static_cast<size_t>((straight + turn) % 8)];
    const int column = cell.x + step.dx;
    const int row = cell.y + step.dy;
    if (column < 0 || row < 0 || column >= index.cols || row >= index.rows) continue;
    const int candidate = index.at<int>(row, column);
    if (candidate < 0) continue;
    const EdgePoint& other = points[static_cast<size_t>(candidate)];
    if (point.normal.dot(other.normal) < kLeastAgreement) continue;
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

// Along `ahead` the edge runs a quarter turn from its normal.
Eigen::Vector2f tangent(const EdgePoint& point) { return {-point.normal.y(), point.normal.x()}; }

Links linkNeighbours(const std::vector<EdgePoint>& points, const std::vector<cv::Point>& cells, const cv::Mat& index) {
  Links best{std::vector<int>(points.size(), -1), std::vector<int>(points.size(), -1)};
  for (size_t i = 0; i < points.size(); ++i) {
    if (index.at<int>(cells[i]) != static_cast<int>(i)) continue;
    const Eigen::Vector2f direction = tangent(points[i]);
    best.ahead[i] = continuation(points, index, cells[i], direction);
    best.behind[i] = continuation(points, index, cells[i], -direction);
  }
  Links mutual = best;
  for (size_t i = 0; i < points.size(); ++i) {
    const int ahead = best.ahead[i];
    if (ahead >= 0 && best.behind[static_cast<size_t>(ahead)] != static_cast<int>(i)) mutual.ahead[i] = -1;
    const int behind = best.behind[i];
    if (behind >= 0 && best.ahead[static_cast<size_t>(behind)] != static_cast<int>(i)) mutual.behind[i] = -1;
  }
  return mutual;
}

}  // namespace

EdgeMap joinChains(const std::vector<EdgePoint>& points, const std::vector<cv::Point>& cells, const cv::Mat& index,
                   int shortest_chain) {
  const Links links = linkNeighbours(points, cells, index);
  EdgeMap edges;
  edges.points.reserve(points.size());
  edges.index = cv::Mat(index.size(), CV_32S, cv::Scalar(-1));
  std::vector<char> visited(points.size(), 0);
  std::vector<size_t> walk;

  const auto takeChain = [&](size_t start) {
    walk.clear();
    int at = static_cast<int>(start);
    while (at >= 0 && !visited[static_cast<size_t>(at)]) {
      visited[static_cast<size_t>(at)] = 1;
      walk.push_back(static_cast<size_t>(at));
      at = links.ahead[static_cast<size_t>(at)];
    }
    if (static_cast<int>(walk.size()) < shortest_chain) return;
    const bool closed = at == static_cast<int>(start);
    const int first = static_cast<int>(edges.points.size());
    const int last = first + static_cast<int>(walk.size()) - 1;
    for (int i = first; i <= last; ++i) {
      const size_t source = walk[static_cast<size_t>(i - first)];
      EdgePoint point = points[source];
      point.chain = edges.chain_count;
      point.previous = i > first ? i - 1 : (closed ? last : -1);
      point.next = i < last ? i + 1 : (closed ? first : -1);
      edges.index.at<int>(cells[source]) = i;
      edges.points.push_back(point);
    }
    ++edges.chain_count;
  };

  // Open chains from their beginnings, in the order of the points; what then is left runs in circles.
  for (const bool open : {true, false}) {
    for (size_t i = 0; i < points.size(); ++i) {
      if (visited[i] || index.at<int>(cells[i]) != static_cast<int>(i)) continue;
      if (open && links.behind[i] >= 0) continue;
      takeChain(i);
    }
  }
  return edges;
}

}  // namespace edgeslam
