#include "mapping/line_views.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace edgeslam {

LineId lineOf(const Keyframe& keyframe, const PointObservation& seen) {
  return seen.straight_edge < 0 ? -1 : keyframe.straight_edges[static_cast<std::size_t>(seen.straight_edge)].line;
}

WorldRay worldRay(const Camera& camera, const Keyframe& keyframe, const EdgeEnd& end) {
  const Pose world_T_row = worldTRow(camera, {keyframe.world_T_camera, keyframe.twist}, end.pixel.y());
  return {world_T_row.translation, world_T_row.rotation * end.bearing};
}

EdgePlane edgePlane(const Camera& camera, const Keyframe& keyframe, const SeenEdge& edge) {
  const Eigen::Vector3d from = worldRay(camera, keyframe, edge.from).direction;
  const Eigen::Vector3d to = worldRay(camera, keyframe, edge.to).direction;
  return {keyframe.world_T_camera.translation, from.cross(to).normalized(), (from + to).normalized()};
}

Eigen::Vector3d normalSeenFrom(const SpaceLine& line, const Eigen::Vector3d& centre) {
  return (line.point - centre).cross(line.direction).normalized();
}

Extent extentOf(const Camera& camera, const SpaceLine& line, const Keyframe& keyframe, const SeenEdge& edge) {
  constexpr double never = std::numeric_limits<double>::infinity();
  Extent extent{never, -never};
  for (const EdgeEnd* end : {&edge.from, &edge.to}) {
    const WorldRay ray = worldRay(camera, keyframe, *end);
    const double distance = distanceAlongRay(line, ray.origin, ray.direction);
    if (!(distance > 0 && distance < never)) return {never, -never};
    const double along = line.direction.dot(ray.origin + distance * ray.direction - line.point);
    extent = {std::min(extent.begin, along), std::max(extent.end, along)};
  }
  return extent;
}

void renewExtent(const Camera& camera, const Map& map, MapLine& line) {
  const SpaceLine in_world = inWorld(map, line);
  line.begin = std::numeric_limits<double>::infinity();
  line.end = -line.begin;
  for (const KeyframeId id : line.seen_in) {
    for (const SeenEdge& edge : map.keyframes[id].straight_edges) {
      if (edge.line != line.id) continue;
      const Extent seen = extentOf(camera, in_world, map.keyframes[id], edge);
      line.begin = std::min(line.begin, seen.begin);
      line.end = std::max(line.end, seen.end);
    }
  }
  if (!(line.begin <= line.end)) line.begin = line.end = 0;
}

}  // namespace edgeslam
