#include "map/worlds.h"

#include <algorithm>
#include <iterator>

namespace edgeslam {
namespace {

// What only keyframes that are gone knew.
void forgetWithoutKeyframes(Map& map) {
  for (auto point = map.points.begin(); point != map.points.end();) {
    point = map.keyframes.contains(point->second.host) ? std::next(point) : map.points.erase(point);
  }
  for (auto line = map.lines.begin(); line != map.lines.end();) {
    std::vector<KeyframeId>& seen_in = line->second.seen_in;
    seen_in.erase(
        std::remove_if(seen_in.begin(), seen_in.end(), [&](KeyframeId id) { return !map.keyframes.contains(id); }),
        seen_in.end());
    line = map.keyframes.contains(line->second.host) ? std::next(line) : map.lines.erase(line);
  }
}

}  // namespace

std::vector<int> worldsOf(const Map& map) {
  std::vector<int> worlds;
  for (const Keyframe& keyframe : map.keyframes) {
    const auto place = std::lower_bound(worlds.begin(), worlds.end(), keyframe.world);
    if (place == worlds.end() || *place != keyframe.world) worlds.insert(place, keyframe.world);
  }
  return worlds;
}

std::vector<KeyframeId> keyframesOf(const Map& map, int world) {
  std::vector<KeyframeId> keyframes;
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.world == world) keyframes.push_back(keyframe.id);
  }
  return keyframes;
}

KeyframeId firstKeyframeOf(const Map& map, int world) {
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.world == world) return keyframe.id;
  }
  return -1;
}

KeyframeId latestKeyframeOf(const Map& map, int world) {
  for (std::size_t place = map.keyframes.size(); place-- > 0;) {
    if (map.keyframes.atPlace(place).world == world) return map.keyframes.atPlace(place).id;
  }
  return -1;
}

KeyframeId keyframeBefore(const Map& map, KeyframeId id) {
  const int world = map.keyframes[id].world;
  for (std::size_t place = map.keyframes.placeOf(id); place-- > 0;) {
    if (map.keyframes.atPlace(place).world == world) return map.keyframes.atPlace(place).id;
  }
  return -1;
}

bool forgetFrom(Map& map, KeyframeId first) {
  if (map.keyframes.empty() || map.keyframes.back().id < first) return false;
  while (!map.keyframes.empty() && map.keyframes.back().id >= first) map.keyframes.erase(map.keyframes.back().id);
  forgetWithoutKeyframes(map);
  return true;
}

void forgetWorld(Map& map, int world) {
  for (const KeyframeId id : keyframesOf(map, world)) map.keyframes.erase(id);
  map.inertia.erase(world);
  map.wheels.erase(world);
  forgetWithoutKeyframes(map);
}

void joinWorlds(const WorldJoin& join, Map& map) {
  for (auto& [id, point] : map.points) {
    if (map.keyframes[point.host].world != join.from) continue;
    point.inverse_depth /= join.to_S_from.scale;
    point.inverse_depth_sigma /= join.to_S_from.scale;
  }
  for (auto& [id, line] : map.lines) {
    if (map.keyframes[line.host].world == join.from) scaleLine(join.to_S_from.scale, line);
  }
  for (Keyframe& keyframe : map.keyframes) {
    if (keyframe.world != join.from) continue;
    keyframe.world_T_camera = moved(join.to_S_from, keyframe.world_T_camera);
    keyframe.twist = moved(join.to_S_from, keyframe.twist);
    keyframe.world = join.to;
  }
  joinInertia(join, map);
  joinWheels(join, map);
}

void joinWheels(const WorldJoin& join, Map& map) {
  const auto known = map.wheels.find(join.from);
  if (known == map.wheels.end()) return;
  WheelScale& older = map.wheels[join.to];
  if (!older.is_known && known->second.is_known) {
    older = known->second;
    older.metres_a_unit /= join.to_S_from.scale;
  }
  map.wheels.erase(join.from);
}

void joinInertia(const WorldJoin& join, Map& map) {
  const auto known = map.inertia.find(join.from);
  if (known == map.inertia.end()) return;
  InertialAlignment& older = map.inertia[join.to];
  if (!older.is_known) older = moved(join.to_S_from, known->second);
  map.inertia.erase(join.from);
}

}  // namespace edgeslam
