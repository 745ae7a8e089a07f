#include "edges/edge_chains.h"

#include <cstddef>

#include "edges/edge_neighbours.h"

namespace edgeslam {
namespace {

constexpr int taken = not_named;  // in place of the neighbour behind: the point is in a chain, or in none at all

// Appends the chain that starts with the point `start` to `edges`.
void takeChain(size_t start, int shortest_chain, EdgeWorkspace& workspace, EdgeMap& edges) {
  const std::vector<EdgePixel>& points = workspace.pixels.points;
  auto* entries = edges.index.ptr<int>(0);
  const auto row_step = static_cast<std::ptrdiff_t>(edges.index.step1());
  const auto entryOf = [&](const EdgePixel& point) -> int& { return entries[point.cell.y * row_step + point.cell.x]; };
  const size_t first = edges.points.size();
  auto at = static_cast<int>(start);
  do {
    const EdgePixel& source = points[static_cast<size_t>(at)];
    const auto here = static_cast<int>(edges.points.size());
    entryOf(source) = here;
    edges.points.push_back({source.pixel, source.normal, source.gradient, edges.chain_count, here - 1, here + 1});
    workspace.behind[static_cast<size_t>(at)] = taken;
    at = workspace.ahead[static_cast<size_t>(at)];
  } while (at >= 0 && workspace.behind[static_cast<size_t>(at)] != taken);
  const size_t end = edges.points.size();
  if (static_cast<int>(end - first) < shortest_chain) {
    at = static_cast<int>(start);
    for (size_t i = first; i < end; ++i) {
      entryOf(points[static_cast<size_t>(at)]) = -1;
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
  chooseNeighbours(workspace.pixels.points, edges.index, workspace.ahead, workspace.behind);
  keepMutual(workspace.ahead, workspace.behind);
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
