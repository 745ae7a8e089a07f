#include "map/keyframe_removal.h"

#include <algorithm>

namespace edgeslam {
namespace {

// The point's place stays; its depth is now told from the first keyframe that saw it besides its host.
void hostElsewhere(const Map& map, MapPoint& point) {
  const Eigen::Vector3d position = worldPosition(map, point);
  const KeyframeId host = point.seen_in.front();
  const Eigen::Vector3d seen = map.keyframes[host].world_T_camera.inverse() * position;
  const double relative_sigma = point.inverse_depth_sigma / point.inverse_depth;
  point.seen_in.erase(point.seen_in.begin());
  point.host = host;
  point.host_bearing = seen.normalized();
  point.inverse_depth = 1 / seen.norm();
  point.inverse_depth_sigma = relative_sigma * point.inverse_depth;
}

void takeOutOfPoints(const Keyframe& keyframe, Map& map) {
  for (const PointObservation& observation : keyframe.observations) {
    const auto found = map.points.find(observation.point);
    if (found == map.points.end()) continue;
    MapPoint& point = found->second;
    if (point.host == keyframe.id && !point.seen_in.empty()) {
      hostElsewhere(map, point);
    } else {
      point.seen_in.erase(std::remove(point.seen_in.begin(), point.seen_in.end(), keyframe.id), point.seen_in.end());
    }
    if (point.seen_in.empty()) map.points.erase(found);
  }
}

void takeOutOfLines(const Keyframe& keyframe, Map& map) {
  for (auto place = map.lines.begin(); place != map.lines.end();) {
    MapLine& line = place->second;
    line.seen_in.erase(std::remove(line.seen_in.begin(), line.seen_in.end(), keyframe.id), line.seen_in.end());
    if (line.seen_in.empty()) {
      place = map.lines.erase(place);
      continue;
    }
    if (line.host == keyframe.id) {
      const SpaceLine in_world = inWorld(map, line);
      line.host = line.seen_in.front();
      setInWorld(in_world, map, line);
    }
    ++place;
  }
}

// The motion to the next keyframe is now told from the one before.
void takeOutOfInertia(const Keyframe& keyframe, Map& map) {
  for (Keyframe& later : map.keyframes) {
    InertialLink& link = later.inertia;
    if (link.from != keyframe.id) continue;
    link.from = keyframe.inertia.from;
    if (link.from >= 0) link.motion = joined(keyframe.inertia.motion, link.motion);
  }
}

}  // namespace

void removeKeyframe(KeyframeId id, Map& map) {
  const Keyframe& keyframe = map.keyframes[id];
  takeOutOfPoints(keyframe, map);
  takeOutOfLines(keyframe, map);
  takeOutOfInertia(keyframe, map);
  map.keyframes.erase(id);
}

}  // namespace edgeslam
