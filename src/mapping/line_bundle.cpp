#include "mapping/line_bundle.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "geometry/median.h"
#include "mapping/line_views.h"

namespace edgeslam {
namespace {

constexpr double farthest_off = 3;             // of a point's ray from its line [px]
constexpr double least_relative_sigma = 1e-4;  // of a point's inverse depth

// Of the inverse distance along a ray, as a line's covariance makes it; the derivatives are numeric.
double inverseDepthVariance(const SpaceLine& line, const Eigen::Matrix4d& covariance, const Eigen::Vector3d& origin,
                            const Eigen::Vector3d& ray, double distance) {
  Eigen::Vector4d derivative;
  for (int k = 0; k < 4; ++k) {
    const double step = 1e-4 * (k < 2 ? distance : 1);
    const Eigen::Vector4d change = step * Eigen::Vector4d::Unit(k);
    derivative(k) = (1 / distanceAlongRay(movedLine(line, change), origin, ray) -
                     1 / distanceAlongRay(movedLine(line, -change), origin, ray)) /
                    (2 * step);
  }
  return derivative.dot(covariance * derivative);
}

// The point is where its host's ray passes the line nearest, and on the line.
void putOnLine(const Camera& camera, const SpaceLine& line, const Eigen::Matrix4d& covariance, const Keyframe& host,
               MapPoint& point) {
  const Eigen::Vector3d& centre = host.world_T_camera.translation;
  const Eigen::Vector3d ray = host.world_T_camera.rotation * point.host_bearing;
  const double distance = distanceAlongRay(line, centre, ray);
  if (!(distance > 0) || !std::isfinite(distance)) return;
  const Eigen::Vector3d on_line = closestPoint(line, centre + distance * ray);
  const double off = (on_line - centre - distance * ray).norm() / distance;
  const double variance = inverseDepthVariance(line, covariance, centre, ray, distance);
  if (!(off * meanFocalLength(camera) < farthest_off) || !(variance >= 0) || !std::isfinite(variance)) return;
  const Eigen::Vector3d in_host = host.world_T_camera.inverse() * on_line;
  point.host_bearing = in_host.normalized();
  point.inverse_depth = 1 / in_host.norm();
  point.inverse_depth_sigma = std::max(least_relative_sigma * point.inverse_depth, std::sqrt(variance));
}

// A point that was on a line which is none is where its host saw it.
void putBackOnItsRay(const Camera& camera, const Keyframe& host, MapPoint& point) {
  const PointObservation* seen = findObservation(host, point.id);
  if (!seen) return;
  const Eigen::Vector3d row_centre = rowPose(camera, host.twist, seen->measurement.pixel.y()).translation;
  setPlace(row_centre, seen->bearing, point.inverse_depth, point.inverse_depth_sigma, point);
}

}  // namespace

void addEnds(const SeenEdge& edge, int camera, int line, BundleProblem& problem) {
  for (const EdgeEnd* end : {&edge.from, &edge.to}) {
    problem.line_observations.push_back({camera, line, end->bearing, end->pixel.y(), edge.sigma});
  }
}

std::map<PointId, LineId> pointsOnLines(const Map& map, const std::vector<KeyframeId>& keyframes) {
  std::map<PointId, std::map<LineId, int>> votes;
  for (const KeyframeId id : keyframes) {
    const Keyframe& keyframe = map.keyframes[id];
    for (const PointObservation& seen : keyframe.observations) {
      const LineId line = lineOf(keyframe, seen);
      if (line >= 0 && map.lines.at(line).is_placed) ++votes[seen.point][line];
    }
  }
  std::map<PointId, LineId> on_lines;
  for (const auto& [point, lines] : votes) {
    const auto found = map.points.find(point);
    if (found == map.points.end() || found->second.corner) continue;
    int all = 0;
    for (const auto& [line, count] : lines) all += count;
    for (const auto& [line, count] : lines) {
      if (2 * count > all) on_lines[point] = line;
    }
  }
  return on_lines;
}

LinesInBundle addLines(const std::vector<KeyframeId>& keyframes, const Map& map,
                       const std::function<int(KeyframeId)>& camera_of, BundleProblem& problem) {
  LinesInBundle added;
  std::set<LineId> lines;
  for (const KeyframeId id : keyframes) {
    for (const SeenEdge& edge : map.keyframes[id].straight_edges) {
      if (edge.line >= 0 && map.lines.at(edge.line).is_placed) lines.insert(edge.line);
    }
  }
  std::set<KeyframeId> seen_in;
  for (const LineId id : lines) {
    const MapLine& line = map.lines.at(id);
    const int index = static_cast<int>(problem.lines.size());
    problem.lines.push_back({inWorld(map, line), false});
    added.lines.push_back(id);
    for (const KeyframeId keyframe : line.seen_in) {
      seen_in.insert(keyframe);
      for (const SeenEdge& edge : map.keyframes[keyframe].straight_edges) {
        if (edge.line == id) addEnds(edge, camera_of(keyframe), index, problem);
      }
    }
  }
  for (const auto& [point, line] : pointsOnLines(map, {seen_in.begin(), seen_in.end()})) {
    if (lines.count(line) > 0) added.line_of_point[point] = line;
  }
  return added;
}

bool readLines(const Camera& camera, const LineOptions& options, const BundleProblem& problem,
               const BundleResult& result, const LinesInBundle& in_bundle, Map& map) {
  std::vector<std::vector<double>> errors(in_bundle.lines.size());
  for (std::size_t k = 0; k < problem.line_observations.size(); ++k) {
    errors[static_cast<std::size_t>(problem.line_observations[k].line)].push_back(result.line_errors[k]);
  }
  std::map<LineId, std::size_t> kept;  // index in the problem
  for (std::size_t i = 0; i < in_bundle.lines.size(); ++i) {
    const LineId id = in_bundle.lines[i];
    if (errors[i].empty() || upperMedian(std::move(errors[i])) > options.largest_error) {
      dissolveLine(id, map);
      continue;
    }
    MapLine& line = map.lines.at(id);
    setInWorld(problem.lines[i].line, map, line);
    renewExtent(camera, map, line);
    kept[id] = i;
  }
  for (const auto& [id, line] : in_bundle.line_of_point) {
    MapPoint& point = map.points.at(id);
    const Keyframe& host = map.keyframes[point.host];
    const auto found = kept.find(line);
    if (found == kept.end()) {
      putBackOnItsRay(camera, host, point);
    } else {
      putOnLine(camera, problem.lines[found->second].line, result.line_covariances[found->second], host, point);
    }
  }
  return kept.size() < in_bundle.lines.size();
}

}  // namespace edgeslam
