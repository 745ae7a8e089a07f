#include "edges/point_choice.h"

#include <algorithm>
#include <cassert>
#include <climits>
#include <cmath>

#include "geometry/measurement.h"

namespace edgeslam {
namespace {

constexpr size_t direction_count = 4;  // of an edge that are told apart, over half a turn

// Of the line that the normal lies on: 0 is level, 1 slants from the upper left to the lower right, 2 is upright.
size_t directionOf(const Eigen::Vector2f& normal) {
  constexpr float tan_of_half_octant = 0.41421356F;
  if (std::abs(normal.y()) < tan_of_half_octant * std::abs(normal.x())) return 0;
  if (std::abs(normal.x()) < tan_of_half_octant * std::abs(normal.y())) return 2;
  return (normal.x() > 0) == (normal.y() > 0) ? 1 : 3;
}

ChosenPoint makePoint(const PointCandidate& candidate, const PointAccuracy& accuracy) {
  ChosenPoint point;
  point.pixel = candidate.pixel;
  point.normal = candidate.normal;
  point.tensor = structureTensor(candidate.products);
  point.corner = candidate.corner;
  point.chain = candidate.chain;
  point.sigma_normal = static_cast<float>(sigmaAcross(point.corner, accuracy));
  const float stretch = std::sqrt(std::max(1.0F, point.tensor.l1 / informativeL2(point.tensor.l2, accuracy)));
  point.sigma_tangent = std::min(point.sigma_normal * stretch, unknown_along);
  return point;
}

// The grid cell in which a pixel lies; of those outside the image the nearest.
class Grid {
 public:
  Grid(const cv::Size& size, int side)
      : side_(std::max(side, 1)), columns_((size.width - 1) / side_ + 1), rows_((size.height - 1) / side_ + 1) {}

  size_t indexOf(const Eigen::Vector2f& pixel) const {
    const auto side = static_cast<float>(side_);
    const auto column = static_cast<int>(std::clamp(pixel.x() / side, 0.0F, static_cast<float>(columns_ - 1)));
    const auto row = static_cast<int>(std::clamp(pixel.y() / side, 0.0F, static_cast<float>(rows_ - 1)));
    const int index = row * columns_ + column;
    return static_cast<size_t>(index);
  }

  size_t count() const {
    const int cells = columns_ * rows_;
    return static_cast<size_t>(cells);
  }

 private:
  int side_;
  int columns_;
  int rows_;
};

const PointCandidate& candidateOf(const PointChoiceWorkspace& workspace, int index) {
  return workspace.candidates[static_cast<size_t>(index)];
}

// The order within a heap: of equally strong candidates the later one is the better.
struct Weaker {
  bool operator()(const RankedCandidate& a, const RankedCandidate& b) const {
    return a.strength < b.strength || (a.strength == b.strength && a.candidate < b.candidate);
  }
};

RankedCandidates& edgesOf(ChoiceCell& cell, const PointCandidate& candidate) {
  return cell.edges[directionOf(candidate.normal)];
}

// Lays the cells' lists out one after the other, each empty but with room for all that was counted in `end`.
int layOut(std::vector<ChoiceCell>& cells) {
  int begin = 0;
  const auto place = [&](RankedCandidates& list) {
    const int count = list.end;
    list = {begin, begin};
    begin += count;
  };
  for (ChoiceCell& cell : cells) {
    place(cell.corners);
    for (RankedCandidates& list : cell.edges) place(list);
  }
  return begin;
}

void sortIntoCells(const Grid& grid, const std::vector<Eigen::Vector2f>& occupied, PointChoiceWorkspace& workspace) {
  std::vector<ChoiceCell>& cells = workspace.cells;
  cells.assign(grid.count(), ChoiceCell());
  for (const Eigen::Vector2f& pixel : occupied) {
    if (pixel.allFinite()) ++cells[grid.indexOf(pixel)].taken;
  }
  for (const PointCandidate& candidate : workspace.candidates) {
    ChoiceCell& cell = cells[grid.indexOf(candidate.pixel)];
    if (candidate.corner) ++cell.corners.end;
    ++edgesOf(cell, candidate).end;
  }
  std::vector<RankedCandidate>& ranked = workspace.ranked;
  ranked.resize(static_cast<size_t>(layOut(cells)));
  const auto append = [&](RankedCandidates& list, float strength, size_t candidate) {
    ranked[static_cast<size_t>(list.end++)] = {strength, static_cast<int>(candidate)};
  };
  for (size_t i = 0; i < workspace.candidates.size(); ++i) {
    const PointCandidate& candidate = workspace.candidates[i];
    ChoiceCell& cell = cells[grid.indexOf(candidate.pixel)];
    if (candidate.corner) append(cell.corners, candidate.l2, i);
    append(edgesOf(cell, candidate), candidate.gradient, i);
  }
  const auto rank = [&](const RankedCandidates& list) {
    std::make_heap(ranked.begin() + list.begin, ranked.begin() + list.end, Weaker());
  };
  for (const ChoiceCell& cell : cells) {
    rank(cell.corners);
    for (const RankedCandidates& list : cell.edges) rank(list);
  }
}

constexpr RankedCandidate no_candidate = {0, -1};

// Removes the best candidate of the list that has room, and returns it; no_candidate when none is left.
RankedCandidate takeBest(PointChoiceWorkspace& workspace, RankedCandidates& list) {
  while (list.begin < list.end) {
    const auto heap = workspace.ranked.begin();
    std::pop_heap(heap + list.begin, heap + list.end, Weaker());
    const RankedCandidate best = workspace.ranked[static_cast<size_t>(--list.end)];
    if (workspace.spacing.isFree(candidateOf(workspace, best.candidate).pixel)) return best;
  }
  return no_candidate;
}

RankedCandidate bestCorner(PointChoiceWorkspace& workspace, ChoiceCell& cell) {
  return takeBest(workspace, cell.corners);
}

// The steepest edge point of the direction of which the cell has fewest points.
RankedCandidate bestEdge(PointChoiceWorkspace& workspace, ChoiceCell& cell) {
  std::array<size_t, direction_count> order = {0, 1, 2, 3};
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    const int taken_a = cell.taken_of_direction[a];
    const int taken_b = cell.taken_of_direction[b];
    return taken_a < taken_b || (taken_a == taken_b && a < b);
  });
  for (const size_t direction : order) {
    const RankedCandidate best = takeBest(workspace, cell.edges[direction]);
    if (best.candidate >= 0) return best;
  }
  return no_candidate;
}

// Cells with the fewest points come first, so that a rich region doesn't take all: in round n each cell with n points
// or fewer gives one, the best candidate of all the cells first. Until `budget` points are taken or nothing is left.
template <typename BestOfCell>
void takeRoundByRound(int budget, BestOfCell best_of_cell, const PointAccuracy& accuracy,
                      PointChoiceWorkspace& workspace, std::vector<ChosenPoint>& chosen) {
  const size_t limit = chosen.size() + static_cast<size_t>(std::max(budget, 0));
  int fullest = 0;
  for (const ChoiceCell& cell : workspace.cells) fullest = std::max(fullest, cell.taken);
  std::vector<CellOffer>& offers = workspace.offers;
  for (int round = 0; chosen.size() < limit; ++round) {
    offers.clear();
    for (size_t i = 0; i < workspace.cells.size(); ++i) {
      if (workspace.cells[i].taken > round) continue;
      const RankedCandidate best = best_of_cell(workspace, workspace.cells[i]);
      if (best.candidate >= 0) offers.push_back({static_cast<int>(i), best.candidate, best.strength});
    }
    if (offers.empty() && round >= fullest) return;
    std::sort(offers.begin(), offers.end(), [](const CellOffer& a, const CellOffer& b) {
      return a.strength > b.strength || (a.strength == b.strength && a.cell < b.cell);
    });
    for (const CellOffer& offer : offers) {
      const PointCandidate& candidate = candidateOf(workspace, offer.candidate);
      if (chosen.size() >= limit || !workspace.spacing.isFree(candidate.pixel)) continue;
      workspace.spacing.add(candidate.pixel);
      chosen.push_back(makePoint(candidate, accuracy));
      ChoiceCell& cell = workspace.cells[static_cast<size_t>(offer.cell)];
      ++cell.taken;
      ++cell.taken_of_direction[directionOf(candidate.normal)];
      fullest = std::max(fullest, cell.taken);
    }
  }
}

// Memory for all that an image of this size may ask for.
void reserve(const cv::Size& size, const EdgeMap& edges, size_t cells, const PointSpread& spread,
             PointChoiceWorkspace& workspace, std::vector<ChosenPoint>& chosen) {
  const size_t most_candidates = std::max(mostEdgePoints(size), edges.points.size()) / candidate_step + 1;
  workspace.candidates.reserve(most_candidates);
  workspace.ranked.reserve(2 * most_candidates);
  workspace.cells.reserve(cells);
  workspace.offers.reserve(cells);
  chosen.reserve(static_cast<size_t>(spread.count));
}

}  // namespace

void choosePoints(const cv::Mat& grey, const EdgeMap& edges, const std::vector<Eigen::Vector2f>& occupied,
                  const PointSpread& spread, const PointAccuracy& accuracy, PointChoiceWorkspace& workspace,
                  std::vector<ChosenPoint>& chosen) {
  chosen.clear();
  const int wanted = spread.count - static_cast<int>(std::min<size_t>(occupied.size(), static_cast<size_t>(INT_MAX)));
  if (grey.empty() || edges.points.empty() || wanted <= 0) return;
  const Grid grid(grey.size(), spread.cell);
  reserve(grey.size(), edges, grid.count(), spread, workspace, chosen);
  workspace.spacing.start(grey.size(), spread.spacing, static_cast<size_t>(spread.count));
  for (const Eigen::Vector2f& pixel : occupied) workspace.spacing.add(pixel);
  workspace.candidates.clear();
  findPointCandidates(grey, edges, workspace.spacing, spread, accuracy, workspace.candidates);
  sortIntoCells(grid, occupied, workspace);

  const int corners = std::min(wanted, static_cast<int>(spread.corner_share * spread.count));
  takeRoundByRound(corners, bestCorner, accuracy, workspace, chosen);
  takeRoundByRound(wanted - static_cast<int>(chosen.size()), bestEdge, accuracy, workspace, chosen);
}

std::vector<ChosenPoint> choosePoints(const cv::Mat& grey, const EdgeMap& edges,
                                      const std::vector<Eigen::Vector2f>& occupied, const PointSpread& spread,
                                      const PointAccuracy& accuracy) {
  PointChoiceWorkspace workspace;
  std::vector<ChosenPoint> chosen;
  choosePoints(grey, edges, occupied, spread, accuracy, workspace, chosen);
  return chosen;
}

std::vector<ChosenPoint> choosePoints(const cv::Mat& grey, const EdgeMap& edges,
                                      const std::vector<Eigen::Vector2f>& occupied, const PointChoiceOptions& options) {
  return choosePoints(grey, edges, occupied, options, PointAccuracy{options.accuracy});
}

}  // namespace edgeslam
