#include "edges/edge_chains.h"

#include <array>
#include <cmath>
#include <limits>

namespace edgeslam {
namespace {

constexpr float kLeastAgreement = 0.6F;  // dot product of the normals of two neighbours along an edge
constexpr int kTaken = -2;               // in place of the neighbour behind: the point is in a chain, or in no edge

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

// The best continuation of `point` among the three pixels ahead in `direction`, or -1.
int continuation(const std::vector<EdgePixel>& points, const cv::Mat& index, const EdgePixel& point,
                 const Eigen::Vector2f& direction) {
  const int straight = octant(direction);
  int best = -1;
  float least_cost = std::numeric_limits<float>::max();
  for (const int turn : {0, 1, 7}) {
    const Step& step = kRing[static_cast<size_t>((straight + turn) % 8)];
    const int column = point.cell.x + step.dx;
    const int row = point.cell.y + step.dy;
    if (column < 0 || row < 0 || column >= index.cols || row >= index.rows) continue;
    const int candidate = index.at<int>(row, column);
    if (candidate < 0) continue;
    const EdgePixel& other = points[static_cast<size_t>(candidate)];
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
Eigen::Vector2f tangent(const EdgePixel& point) { return {-point.normal.y(), point.normal.x()}; }

bool isNamed(const cv::Mat& index, const EdgePixel& point, size_t i) {
  return index.at<int>(point.cell) == static_cast<int>(i);
}

void chooseNeighbours(const cv::Mat& index, EdgeWorkspace& workspace) {
  const std::vector<EdgePixel>& points = workspace.pixels.points;
  for (size_t i = 0; i < points.size(); ++i) {
    workspace.ahead[i] = -1;
    workspace.behind[i] = kTaken;
    if (!isNamed(index, points[i], i)) continue;
    const Eigen::Vector2f direction = tangent(points[i]);
    workspace.ahead[i] = continuation(points, index, points[i], direction);
    workspace.behind[i] = continuation(points, index, points[i], -direction);
  }
}

// Of the two ways of a choice only those stay that are mutual.
void dropOneSided(std::vector<int>& ahead, std::vector<int>& behind) {
  for (size_t i = 0; i < ahead.size(); ++i) {
    const int next = ahead[i];
    if (next >= 0 && behind[static_cast<size_t>(next)] != static_cast<int>(i)) ahead[i] = -1;
  }
  for (size_t i = 0; i < behind.size(); ++i) {
    const int previous = behind[i];
    if (previous >= 0 && ahead[static_cast<size_t>(previous)] != static_cast<int>(i)) behind[i] = -1;
  }
}

// Appends the chain that starts with the point `start` to `edges`.
void takeChain(size_t start, int shortest_chain, EdgeWorkspace& workspace, EdgeMap& edges) {
  const size_t first = edges.points.size();
  auto at = static_cast<int>(start);
  do {
    const EdgePixel& source = workspace.pixels.points[static_cast<size_t>(at)];
    const auto here = static_cast<int>(edges.points.size());
    edges.index.at<int>(source.cell) = here;
    edges.points.push_back({source.pixel, source.normal, source.gradient, edges.chain_count, here - 1, here + 1});
    workspace.behind[static_cast<size_t>(at)] = kTaken;
    at = workspace.ahead[static_cast<size_t>(at)];
  } while (at >= 0 && workspace.behind[static_cast<size_t>(at)] != kTaken);
  const size_t end = edges.points.size();
  if (static_cast<int>(end - first) < shortest_chain) {
    at = static_cast<int>(start);
    for (size_t i = first; i < end; ++i) {
      edges.index.at<int>(workspace.pixels.points[static_cast<size_t>(at)].cell) = -1;
      at = workspace.ahead[static_cast<size_t>(at)];
    }
    edges.points.resize(first);
    return;
  }
  const bool closed = at == static_cast<int>(start);
  edges.points[first].previous = closed ? static_cast<int>(end) - 1 : -1;
  edges.points[end - 1].next = closed ? static_cast<int>(first) : -1;
  ++edges.chain_count;
}

}  // namespace

void joinChains(int shortest_chain, EdgeWorkspace& workspace, EdgeMap& edges) {
  const size_t count = workspace.pixels.points.size();
  workspace.ahead.resize(count);
  workspace.behind.resize(count);
  chooseNeighbours(edges.index, workspace);
  dropOneSided(workspace.ahead, workspace.behind);
  edges.points.clear();
  edges.chain_count = 0;
  // Open chains from their beginnings, in the order of the points; what then is left runs in circles.
  for (size_t i = 0; i < count; ++i) {
    if (workspace.behind[i] == -1) takeChain(i, shortest_chain, workspace, edges);
  }
  for (size_t i = 0; i < count; ++i) {
    if (workspace.behind[i] >= 0) takeChain(i, shortest_chain, workspace, edges);
  }
}

}  // namespace edgeslam
