#include "mapping/culling.h"

#include <algorithm>
#include <cassert>
#include <iterator>

#include "map/keyframe_removal.h"
#include "map/worlds.h"

namespace edgeslam {
namespace {

// The points of a keyframe, by how many other keyframes see them.
struct Need {
  int points = 0;
  int replaceable = 0;  // seen by enough others
  int lost = 0;         // gone without it
};

Need needFor(const CullingOptions& options, const Map& map, const Keyframe& keyframe) {
  Need need;
  for (const PointObservation& observation : keyframe.observations) {
    const auto found = map.points.find(observation.point);
    if (found == map.points.end()) continue;
    const MapPoint& point = found->second;
    const bool sees =
        point.host == keyframe.id || std::binary_search(point.seen_in.begin(), point.seen_in.end(), keyframe.id);
    if (!sees) continue;  // an outlier's observation
    const auto others = static_cast<int>(point.seen_in.size());
    ++need.points;
    need.replaceable += others >= options.other_views ? 1 : 0;
    need.lost += others < 2 ? 1 : 0;
  }
  return need;
}

CulledKeyframe takeOut(KeyframeId id, Map& map, Candidates& candidates) {
  for (auto candidate = candidates.begin(); candidate != candidates.end();) {
    std::vector<KeyframeId>& views = candidate->second;
    views.erase(std::remove(views.begin(), views.end(), id), views.end());
    candidate = views.empty() ? candidates.erase(candidate) : std::next(candidate);
  }
  const Keyframe& kept = map.keyframes[keyframeBefore(map, id)];
  const CulledKeyframe culled{id, kept.id, kept.world_T_camera.inverse() * map.keyframes[id].world_T_camera,
                              kept.world};
  removeKeyframe(id, map);
  return culled;
}

bool mayGo(const CullingOptions& options, const Map& map, KeyframeId id) {
  const auto place = map.keyframes.placeOf(id);
  return keyframeBefore(map, id) >= 0 &&
         place + static_cast<std::size_t>(options.recent_keyframes) < map.keyframes.size();
}

// The smallest of those that the camera is not in, if it is small; or -1.
int leastUsefulWorld(const CullingOptions& options, const Map& map) {
  int least = -1;
  auto fewest = static_cast<std::size_t>(options.small_world_keyframes) + 1;
  for (const int world : worldsOf(map)) {
    const std::size_t keyframes = keyframesOf(map, world).size();
    if (world == map.keyframes.back().world || keyframes >= fewest) continue;
    least = world;
    fewest = keyframes;
  }
  return least;
}

void takeOutWorld(int world, Map& map, std::vector<CulledKeyframe>& culled) {
  for (const KeyframeId id : keyframesOf(map, world)) {
    culled.push_back({id, -1, map.keyframes[id].world_T_camera, world});
  }
  forgetWorld(map, world);
}

// Those around the latest keyframe, where views are added.
std::vector<KeyframeId> redundantKeyframes(const CullingOptions& options, const Map& map) {
  std::vector<KeyframeId> redundant;
  const std::vector<int> shared = sharedPoints(map, map.keyframes.back().id);
  for (const Keyframe& keyframe : map.keyframes) {
    if (!mayGo(options, map, keyframe.id) || shared[static_cast<std::size_t>(keyframe.id)] == 0) continue;
    const Need need = needFor(options, map, keyframe);
    if (need.replaceable >= options.redundant_share * need.points) redundant.push_back(keyframe.id);
  }
  return redundant;
}

bool overBounds(const CullingOptions& options, const Map& map) {
  return static_cast<int>(map.keyframes.size()) > options.most_keyframes ||
         static_cast<double>(memoryOf(map)) > options.most_megabytes * 1e6;
}

// The latest of those that the fewest points are lost with, or -1: of two that show the same the older one stays.
KeyframeId leastNeeded(const CullingOptions& options, const Map& map) {
  KeyframeId least = -1;
  int fewest = 0;
  for (const Keyframe& keyframe : map.keyframes) {
    if (!mayGo(options, map, keyframe.id)) continue;
    const int lost = needFor(options, map, keyframe).lost;
    if (least >= 0 && lost > fewest) continue;
    least = keyframe.id;
    fewest = lost;
  }
  return least;
}

}  // namespace

std::size_t memoryOf(const Map& map) {
  std::size_t bytes = 0;
  for (const Keyframe& keyframe : map.keyframes) {
    bytes += sizeof(Keyframe) + keyframe.observations.capacity() * sizeof(PointObservation) +
             keyframe.straight_edges.capacity() * sizeof(SeenEdge) + keyframe.images.size();
  }
  constexpr std::size_t node = 4 * sizeof(void*);  // of the ordered map
  for (const auto& [id, point] : map.points) {
    bytes += node + sizeof(id) + sizeof(point) + point.seen_in.capacity() * sizeof(KeyframeId);
  }
  for (const auto& [id, line] : map.lines) {
    bytes += node + sizeof(id) + sizeof(line) + line.seen_in.capacity() * sizeof(KeyframeId);
  }
  return bytes;
}

std::vector<CulledKeyframe> cullKeyframes(const CullingOptions& options, Map& map, Candidates& candidates) {
  std::vector<CulledKeyframe> culled;
  if (!options.enabled) return culled;
  assert(!map.keyframes.empty());
  for (const KeyframeId id : redundantKeyframes(options, map)) {
    const Need need = needFor(options, map, map.keyframes[id]);  // others that went may have left it needed
    if (need.replaceable < options.redundant_share * need.points) continue;
    culled.push_back(takeOut(id, map, candidates));
  }
  while (overBounds(options, map)) {
    const int world = leastUsefulWorld(options, map);
    if (world >= 0) {
      takeOutWorld(world, map, culled);
      continue;
    }
    const KeyframeId id = leastNeeded(options, map);
    if (id < 0) break;
    culled.push_back(takeOut(id, map, candidates));
  }
  return culled;
}

}  // namespace edgeslam
