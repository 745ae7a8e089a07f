#include "map/map.h"

#include <algorithm>

#include "geometry/median.h"

namespace edgeslam {

SpaceLine inWorld(const Map& map, const MapLine& line) {
  const Pose& world_T_host = map.keyframes[line.host].world_T_camera;
  return {world_T_host * line.in_host.point, world_T_host.rotation * line.in_host.direction};
}

void setInWorld(const SpaceLine& in_world, const Map& map, MapLine& line) {
  const Pose host_T_world = map.keyframes[line.host].world_T_camera.inverse();
  line.in_host = {host_T_world * in_world.point, host_T_world.rotation * in_world.direction};
}

void scaleLine(double factor, MapLine& line) {
  line.in_host.point *= factor;
  line.begin *= factor;
  line.end *= factor;
}

void dissolveLine(LineId id, Map& map) {
  map.lines.erase(id);
  for (Keyframe& keyframe : map.keyframes) {
    for (SeenEdge& edge : keyframe.straight_edges) {
      if (edge.line == id) edge.line = -1;
    }
  }
}

void setPlace(const Eigen::Vector3d& ray_origin, const Eigen::Vector3d& direction, double inverse_depth, double sigma,
              MapPoint& point) {
  point.host_bearing = direction;
  point.inverse_depth = inverse_depth;
  point.inverse_depth_sigma = sigma;
  if (ray_origin.isZero(0)) return;
  const Eigen::Vector3d place = ray_origin + direction / inverse_depth;
  point.host_bearing = place.normalized();
  point.inverse_depth = 1 / place.norm();
  point.inverse_depth_sigma = sigma / inverse_depth * point.inverse_depth;
}

const PointObservation* findObservation(const Keyframe& keyframe, PointId point) {
  const auto found = std::lower_bound(keyframe.observations.begin(), keyframe.observations.end(), point,
                                      [](const PointObservation& o, PointId id) { return o.point < id; });
  return found != keyframe.observations.end() && found->point == point ? &*found : nullptr;
}

PointId firstFreePoint(const Map& map) {
  PointId first = 0;
  for (const Keyframe& keyframe : map.keyframes) {
    if (!keyframe.observations.empty()) first = std::max(first, keyframe.observations.back().point + 1);
  }
  return first;
}

double sceneDistance(const Map& map, const Keyframe& keyframe, std::size_t fewest) {
  std::vector<double> distances;
  for (const PointObservation& seen : keyframe.observations) {
    const auto point = map.points.find(seen.point);
    if (point == map.points.end()) continue;
    distances.push_back((worldPosition(map, point->second) - keyframe.world_T_camera.translation).norm());
  }
  return distances.empty() || distances.size() < fewest ? 0 : upperMedian(distances);
}

std::vector<int> sharedPoints(const Map& map, KeyframeId keyframe) {
  std::vector<int> shared(numberOfKeyframes(map), 0);
  for (const PointObservation& observation : map.keyframes[keyframe].observations) {
    const auto point = map.points.find(observation.point);
    if (point == map.points.end()) continue;
    ++shared[static_cast<std::size_t>(point->second.host)];
    for (const KeyframeId other : point->second.seen_in) ++shared[static_cast<std::size_t>(other)];
  }
  shared[static_cast<std::size_t>(keyframe)] = 0;
  return shared;
}

}  // namespace edgeslam
