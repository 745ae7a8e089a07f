#include "map/map_cropping.h"

#include <algorithm>
#include <iterator>

#include "map/keyframe_removal.h"
#include "map/worlds.h"

namespace edgeslam {
namespace {

bool isBoxedOut(const MapCropping& cropping, int world, const Eigen::Vector3d& position) {
  if (world != cropping.world) return false;
  if (cropping.kept && !cropping.kept->holds(position)) return true;
  return std::any_of(cropping.removed_boxes.begin(), cropping.removed_boxes.end(),
                     [&](const MapBox& box) { return box.holds(position); });
}

bool isToGo(const MapCropping& cropping, const Keyframe& keyframe) {
  return isBoxedOut(cropping, keyframe.world, keyframe.world_T_camera.translation) ||
         std::any_of(cropping.removed_keyframes.begin(), cropping.removed_keyframes.end(),
                     [&](const auto& range) { return keyframe.id >= range.first && keyframe.id <= range.second; });
}

Eigen::Vector3d middleOf(const Map& map, const MapLine& line) {
  const SpaceLine in_world = inWorld(map, line);
  return in_world.point + 0.5 * (line.begin + line.end) * in_world.direction;
}

void removePointsAndLines(const MapCropping& cropping, Map& map) {
  for (auto point = map.points.begin(); point != map.points.end();) {
    const int world = map.keyframes[point->second.host].world;
    const bool goes = isBoxedOut(cropping, world, worldPosition(map, point->second));
    point = goes ? map.points.erase(point) : std::next(point);
  }
  std::vector<LineId> lines;
  for (const auto& [id, line] : map.lines) {
    const int world = map.keyframes[line.host].world;
    if (line.is_placed && isBoxedOut(cropping, world, middleOf(map, line))) lines.push_back(id);
  }
  for (const LineId id : lines) dissolveLine(id, map);
}

bool seesPoints(const Map& map, const Keyframe& keyframe) {
  return std::any_of(keyframe.observations.begin(), keyframe.observations.end(),
                     [&](const PointObservation& observation) { return map.points.count(observation.point) > 0; });
}

std::size_t placedLines(const Map& map) {
  return static_cast<std::size_t>(
      std::count_if(map.lines.begin(), map.lines.end(), [](const auto& entry) { return entry.second.is_placed; }));
}

template <typename Which>
void removeKeyframes(const Which& goes, Map& map) {
  std::vector<KeyframeId> going;
  for (const Keyframe& keyframe : map.keyframes) {
    if (goes(keyframe)) going.push_back(keyframe.id);
  }
  for (const KeyframeId id : going) removeKeyframe(id, map);
}

}  // namespace

RemovedParts cropMap(const MapCropping& cropping, Map& map) {
  const std::size_t keyframes = map.keyframes.size(), points = map.points.size(), lines = placedLines(map);
  for (const int world : cropping.removed_worlds) forgetWorld(map, world);
  removePointsAndLines(cropping, map);
  removeKeyframes([&](const Keyframe& keyframe) { return isToGo(cropping, keyframe); }, map);
  removeKeyframes([&](const Keyframe& keyframe) { return !seesPoints(map, keyframe); }, map);
  return {keyframes - map.keyframes.size(), points - map.points.size(), lines - placedLines(map)};
}

}  // namespace edgeslam
