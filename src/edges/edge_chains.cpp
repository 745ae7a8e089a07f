#include "edges/edge_chains.h"

#include "edges/edge_neighbours.h"

namespace edgeslam {
namespace {

constexpr int kTaken = kNotNamed;  // in place of the neighbour behind: the point is in a chain, or in none at all

// Of the two ways of a choice only those stay that are mutual.
void keepMutual(std::vector<int>& ahead, std::vector<int>& behind) {
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
