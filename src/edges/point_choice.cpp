#include "edges/point_choice.h"

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>

#include "edges/point_spacing.h"
#include "image/gradient.h"

namespace edgeslam {
namespace {

constexpr int kStep = 2;  // along a chain every second edge point is a candidate: tensors change little in between
constexpr int kNormalReach = 6;        // neighbours on each side over which a normal is averaged [points]
constexpr int kDirections = 4;         // directions of an edge that are told apart, over half a turn
constexpr float kLeastL2 = 1e-6F;      // [grey^2/px^2]
constexpr float kUnknownAlong = 1000;  // standard deviation of a point that nothing holds along its edge [px]

struct Candidate {
  ChosenPoint point;
  float gradient = 0;  // of its edge point [grey/px]
};

// The candidates of one grid cell: indices, best first, and how many points the cell has already.
struct Cell {
  std::vector<int> corners;
  std::array<std::vector<int>, kDirections> edges;
  std::array<int, kDirections> taken_of_direction{};
  int taken = 0;
};

int directionOf(const Eigen::Vector2f& normal) {
  const float half_turns = std::atan2(normal.y(), normal.x()) / static_cast<float>(M_PI) + 1;
  return static_cast<int>(std::lround(half_turns * kDirections)) % kDirections;
}

// Mean normal of an edge point and as many neighbours along the chain before as after it, so that a bend does not turn
// it. A third as noisy as the point's own, and free of the skew that central differences give the tensor on sharp
// edges.
Eigen::Vector2f normalAlongChain(const EdgeMap& edges, const EdgePoint& edge) {
  Eigen::Vector2f sum = edge.normal;
  int before = edge.previous;
  int after = edge.next;
  for (int step = 0; step < kNormalReach && before >= 0 && after >= 0; ++step) {
    const EdgePoint& behind = edges.points[static_cast<size_t>(before)];
    const EdgePoint& ahead = edges.points[static_cast<size_t>(after)];
    sum += behind.normal + ahead.normal;
    before = behind.previous;
    after = ahead.next;
  }
  const float length = sum.norm();
  return length > 0 ? Eigen::Vector2f(sum / length) : edge.normal;
}

Candidate makeCandidate(const TwiceGradient& gradient, const EdgeMap& edges, const EdgePoint& edge,
                        const PointChoiceOptions& options) {
  Candidate candidate;
  candidate.gradient = edge.gradient;
  ChosenPoint& point = candidate.point;
  point.pixel = edge.pixel;
  point.tensor = structureTensor(gradient, edge.pixel, options.tensor_window);
  point.chain = edge.chain;
  const float l1 = point.tensor.l1;
  const float l2 = point.tensor.l2;
  point.corner = l2 > static_cast<float>(options.corner_ratio) * l1 && l2 > static_cast<float>(options.corner_strength);
  if (point.corner) {
    point.normal = point.tensor.direction.dot(edge.normal) < 0 ? -point.tensor.direction : point.tensor.direction;
  } else {
    point.normal = normalAlongChain(edges, edge);
  }
  point.sigma_normal = static_cast<float>(point.corner ? options.sigma_corner : options.sigma_edge);
  const float informative_l2 = std::max(l2 - static_cast<float>(options.noise), kLeastL2);
  point.sigma_tangent = std::min(point.sigma_normal * std::sqrt(std::max(1.0F, l1 / informative_l2)), kUnknownAlong);
  return candidate;
}

std::vector<Candidate> findCandidates(const cv::Mat& grey, const EdgeMap& edges, const PointSpacing& spacing,
                                      const PointChoiceOptions& options) {
  const auto border = static_cast<float>(options.border);
  const float right = static_cast<float>(grey.cols - 1) - border;
  const float bottom = static_cast<float>(grey.rows - 1) - border;
  const TwiceGradient gradient = twiceGradient(grey);
  std::vector<Candidate> candidates;
  candidates.reserve(edges.points.size() / kStep + 1);
  for (size_t i = 0; i < edges.points.size(); i += kStep) {
    const EdgePoint& edge = edges.points[i];
    if (edge.pixel.x() < border || edge.pixel.y() < border || edge.pixel.x() > right || edge.pixel.y() > bottom)
      continue;
    if (spacing.isFree(edge.pixel)) candidates.push_back(makeCandidate(gradient, edges, edge, options));
  }
  return candidates;
}

class Grid {
 public:
  Grid(const cv::Size& size, int side)
      : side_(std::max(side, 1)), columns_((size.width - 1) / side_ + 1), rows_((size.height - 1) / side_ + 1) {
    const int count = columns_ * rows_;
    cells_.resize(static_cast<size_t>(count));
  }

  Cell& at(const Eigen::Vector2f& pixel) {
    const auto side = static_cast<float>(side_);
    const auto column = static_cast<int>(std::clamp(pixel.x() / side, 0.0F, static_cast<float>(columns_ - 1)));
    const auto row = static_cast<int>(std::clamp(pixel.y() / side, 0.0F, static_cast<float>(rows_ - 1)));
    const int index = row * columns_ + column;
    return cells_[static_cast<size_t>(index)];
  }

  std::vector<Cell>& cells() { return cells_; }

 private:
  int side_;
  int columns_;
  int rows_;
  std::vector<Cell> cells_;
};

Grid sortIntoCells(const cv::Size& size, const std::vector<Candidate>& candidates,
                   const std::vector<Eigen::Vector2f>& occupied, int side) {
  Grid grid(size, side);
  for (const Eigen::Vector2f& pixel : occupied) {
    if (pixel.allFinite()) ++grid.at(pixel).taken;
  }
  for (size_t i = 0; i < candidates.size(); ++i) {
    Cell& cell = grid.at(candidates[i].point.pixel);
    const auto index = static_cast<int>(i);
    if (candidates[i].point.corner) cell.corners.push_back(index);
    cell.edges[static_cast<size_t>(directionOf(candidates[i].point.normal))].push_back(index);
  }
  const auto l2 = [&](int i) { return candidates[static_cast<size_t>(i)].point.tensor.l2; };
  const auto gradient = [&](int i) { return candidates[static_cast<size_t>(i)].gradient; };
  // The worst first, so that the best is taken from the end.
  for (Cell& cell : grid.cells()) {
    std::stable_sort(cell.corners.begin(), cell.corners.end(), [&](int a, int b) { return l2(a) < l2(b); });
    for (auto& edges : cell.edges) {
      std::stable_sort(edges.begin(), edges.end(), [&](int a, int b) { return gradient(a) < gradient(b); });
    }
  }
  return grid;
}

// Removes the best candidate of the list that has room, and returns its index; -1 when none is left.
int takeBest(std::vector<int>& list, const std::vector<Candidate>& candidates, const PointSpacing& spacing) {
  while (!list.empty()) {
    const int best = list.back();
    list.pop_back();
    if (spacing.isFree(candidates[static_cast<size_t>(best)].point.pixel)) return best;
  }
  return -1;
}

int bestCorner(Cell& cell, const std::vector<Candidate>& candidates, const PointSpacing& spacing) {
  return takeBest(cell.corners, candidates, spacing);
}

// The steepest edge point of the direction of which the cell has fewest points.
int bestEdge(Cell& cell, const std::vector<Candidate>& candidates, const PointSpacing& spacing) {
  std::array<size_t, kDirections> order = {0, 1, 2, 3};
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return cell.taken_of_direction[a] < cell.taken_of_direction[b]; });
  for (const size_t direction : order) {
    const int best = takeBest(cell.edges[direction], candidates, spacing);
    if (best >= 0) return best;
  }
  return -1;
}

// Cells with the fewest points come first, so that a rich region doesn't take all: in round n each cell with n points
// or fewer gives one, the best candidate of all the cells first. Until `budget` points are taken or nothing is left.
template <typename BestOfCell, typename Strength>
void takeRoundByRound(Grid& grid, const std::vector<Candidate>& candidates, int budget, BestOfCell best_of_cell,
                      Strength strength, PointSpacing& spacing, std::vector<ChosenPoint>& chosen) {
  struct Offer {
    Cell* cell;
    int candidate;
  };
  const size_t limit = chosen.size() + static_cast<size_t>(std::max(budget, 0));
  int fullest = 0;
  for (const Cell& cell : grid.cells()) fullest = std::max(fullest, cell.taken);
  std::vector<Offer> offers;
  for (int round = 0; chosen.size() < limit; ++round) {
    offers.clear();
    for (Cell& cell : grid.cells()) {
      if (cell.taken > round) continue;
      const int best = best_of_cell(cell, candidates, spacing);
      if (best >= 0) offers.push_back({&cell, best});
    }
    if (offers.empty() && round >= fullest) return;
    std::stable_sort(offers.begin(), offers.end(),
                     [&](const Offer& a, const Offer& b) { return strength(a.candidate) > strength(b.candidate); });
    for (const Offer& offer : offers) {
      const ChosenPoint& point = candidates[static_cast<size_t>(offer.candidate)].point;
      if (chosen.size() >= limit || !spacing.isFree(point.pixel)) continue;
      spacing.add(point.pixel);
      chosen.push_back(point);
      ++offer.cell->taken;
      ++offer.cell->taken_of_direction[static_cast<size_t>(directionOf(point.normal))];
      fullest = std::max(fullest, offer.cell->taken);
    }
  }
}

}  // namespace

std::vector<ChosenPoint> choosePoints(const cv::Mat& grey, const EdgeMap& edges,
                                      const std::vector<Eigen::Vector2f>& occupied, const PointChoiceOptions& options) {
  const int wanted = options.count - static_cast<int>(std::min<size_t>(occupied.size(), static_cast<size_t>(INT_MAX)));
  if (grey.empty() || edges.points.empty() || wanted <= 0) return {};
  PointSpacing spacing(grey.size(), options.spacing);
  for (const Eigen::Vector2f& pixel : occupied) spacing.add(pixel);
  const std::vector<Candidate> candidates = findCandidates(grey, edges, spacing, options);
  Grid grid = sortIntoCells(grey.size(), candidates, occupied, options.cell);

  std::vector<ChosenPoint> chosen;
  chosen.reserve(static_cast<size_t>(wanted));
  const int corners = std::min(wanted, static_cast<int>(options.corner_share * options.count));
  takeRoundByRound(
      grid, candidates, corners, bestCorner, [&](int i) { return candidates[static_cast<size_t>(i)].point.tensor.l2; },
      spacing, chosen);
  takeRoundByRound(
      grid, candidates, wanted - static_cast<int>(chosen.size()), bestEdge,
      [&](int i) { return candidates[static_cast<size_t>(i)].gradient; }, spacing, chosen);
  return chosen;
}

}  // namespace edgeslam
