// A placed line of the map, and views of it.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "map/map.h"

namespace edgeslam::test {

// Seen by these keyframes of the map, hosted in the first of them.
inline void addSeenLine(const Camera& camera, LineId id, std::vector<KeyframeId> seen_in, Map& map) {
  MapLine line;
  line.id = id;
  line.host = seen_in.front();
  line.in_host = {{0.3, -0.4, 5}, Eigen::Vector3d(1, 2, 0.1 * static_cast<double>(id)).normalized()};
  line.is_placed = true;
  line.begin = -0.5;
  line.end = 1.5;
  line.seen_in = std::move(seen_in);
  const EdgeEnd from{{100, 100}, bearing(camera, {100, 100})}, to{{200, 300}, bearing(camera, {200, 300})};
  for (const KeyframeId keyframe : line.seen_in) map.keyframes[keyframe].straight_edges.push_back({id, from, to, 1e-3});
  map.next_line = std::max(map.next_line, id + 1);
  map.lines.emplace(id, std::move(line));
}

}  // namespace edgeslam::test
