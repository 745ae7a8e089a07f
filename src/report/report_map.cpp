#include "report/report_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "geometry/median.h"

namespace edgeslam {
namespace {

// Two points that follow each other along a chain.
struct Link {
  double gap = 0;    // in order, at least 1
  double slope = 0;  // distance over depth and gap
};

double depthFromNearest(const Eigen::Vector3d& position, const std::vector<Eigen::Vector3d>& cameras) {
  double least = std::numeric_limits<double>::max();
  for (const Eigen::Vector3d& camera : cameras) least = std::min(least, (position - camera).squaredNorm());
  return cameras.empty() ? 1.0 : std::max(std::sqrt(least), 1e-12);
}

Link linkBetween(const MapPointRecord& from, const MapPointRecord& to, const std::vector<Eigen::Vector3d>& cameras) {
  const double gap = std::max(1.0, std::abs(static_cast<double>(to.order) - from.order));
  const double depth = depthFromNearest(0.5 * (from.position + to.position), cameras);
  return {gap, (to.position - from.position).norm() / (depth * gap)};
}

// Along both points' edges: then a long link is one that runs in depth, not an outlier.
bool followsEdges(const MapPointRecord& from, const MapPointRecord& to) {
  const Eigen::Vector3d direction = (to.position - from.position).normalized();
  constexpr double least_cosine = 0.9;
  return std::abs(direction.dot(from.edge_direction)) > least_cosine &&
         std::abs(direction.dot(to.edge_direction)) > least_cosine;
}

// A few hundred cameras tell the depth as well as all of a long run.
std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& cameras) {
  constexpr std::size_t most = 200;
  const std::size_t stride = 1 + cameras.size() / most;
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t i = 0; i < cameras.size(); i += stride) {
    if (cameras[i].allFinite()) kept.push_back(cameras[i]);
  }
  return kept;
}

}  // namespace

std::vector<std::vector<int>> joinChains(const std::vector<MapPointRecord>& points,
                                         const std::vector<Eigen::Vector3d>& all_cameras) {
  const std::vector<Eigen::Vector3d> cameras = thinned(all_cameras);
  std::vector<int> sorted;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].position.allFinite()) sorted.push_back(static_cast<int>(i));
  }
  const auto at = [&points](int index) -> const MapPointRecord& { return points[static_cast<std::size_t>(index)]; };
  std::sort(sorted.begin(), sorted.end(), [&at](int a, int b) {
    return std::tie(at(a).chain, at(a).order, a) < std::tie(at(b).chain, at(b).order, b);
  });

  std::vector<Link> links(sorted.size());  // links[i] leads from sorted[i - 1] to sorted[i]
  std::vector<double> gaps;
  std::vector<double> slopes;
  const auto same_chain = [&](std::size_t i) {
    return i > 0 && at(sorted[i]).chain >= 0 && at(sorted[i]).chain == at(sorted[i - 1]).chain;
  };
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (!same_chain(i)) continue;
    links[i] = linkBetween(at(sorted[i - 1]), at(sorted[i]), cameras);
    gaps.push_back(links[i].gap);
    slopes.push_back(links[i].slope);
  }
  // In multiples of the medians, which hold whether `order` counts pixels or chosen points.
  const double longest_gap = 8 * medianOr(0.0, gaps);
  const double usual_slope = medianOr(0.0, slopes);
  const auto joined = [&](std::size_t i) {
    if (!same_chain(i) || links[i].gap > longest_gap) return false;
    if (links[i].slope <= 4 * usual_slope) return true;
    return links[i].slope <= 20 * usual_slope && followsEdges(at(sorted[i - 1]), at(sorted[i]));
  };

  std::vector<std::vector<int>> lines;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (!joined(i)) lines.emplace_back();
    lines.back().push_back(sorted[i]);
  }
  return lines;
}

}  // namespace edgeslam
