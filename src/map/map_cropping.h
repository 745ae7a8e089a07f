// Parts of a map taken out of it: what lies in a box, keyframes, whole worlds.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "map/map.h"

namespace edgeslam {

// Its bounds belong to it. Bounds may be infinite.
struct MapBox {
  Eigen::Vector3d least = Eigen::Vector3d::Zero(), most = Eigen::Vector3d::Zero();  // world [map units]

  bool holds(const Eigen::Vector3d& position) const {
    return (position.array() >= least.array()).all() && (position.array() <= most.array()).all();
  }
};

struct MapCropping {
  int world = 0;                                                     // that the boxes are in
  std::optional<MapBox> kept;                                        // what lies outside is taken out
  std::vector<MapBox> removed_boxes;                                 // and what lies in one of these
  std::vector<std::pair<KeyframeId, KeyframeId>> removed_keyframes;  // from the first to the last one
  std::vector<int> removed_worlds;
};

struct RemovedParts {
  std::size_t keyframes = 0, points = 0, lines = 0;  // lines that were placed
};

// Where a keyframe lies is where its camera was, and where a line lies the middle of what was seen of it. Points that
// fewer than two of the keyframes left see are taken out too, and keyframes that see none of the points left.
// Coordinates and numbers of what is left stay.
RemovedParts cropMap(const MapCropping& cropping, Map& map);

}  // namespace edgeslam
