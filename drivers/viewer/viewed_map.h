// The map as the page draws it, and what changed of it since a client was last sent one: a map of some minutes changes
// around the camera only.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/camera.h"
#include "map/map.h"

namespace edgeslam {

struct ViewedPoint {
  PointId id = 0;
  std::array<float, 3> position{};  // world [map units]
  std::uint8_t grey = 0;
  std::uint8_t depth_sigma_percent = 0;  // standard deviation of the depth
  std::uint8_t joined = 0;               // 1: a line comes from the point before
};

struct ViewedKeyframe {
  KeyframeId id = 0;
  std::array<float, 7> pose{};  // world_T_camera: position; rotation x, y, z, w
};

using ViewedLine = std::array<float, 6>;  // from, to: world [map units]

struct ViewedMap {
  std::int64_t number = 0;  // over 0, another for every map
  int world = 0;
  std::vector<ViewedPoint> points;  // along the edges
  std::vector<ViewedKeyframe> keyframes;
  std::vector<ViewedLine> lines;
  std::size_t points_in_map = 0, keyframes_in_map = 0;  // of this world
};

using SharedMap = std::shared_ptr<const ViewedMap>;

constexpr std::size_t most_viewed_points = 20000;
constexpr std::size_t most_viewed_keyframes = 2000;
constexpr std::size_t most_viewed_lines = 2000;

// One world of the map: at most most_viewed_points of the map's points, most_viewed_keyframes and most_viewed_lines,
// spread evenly, and the same ones as long as the map does not grow; what is not finite is left out.
ViewedMap viewedMap(const Map& map, int world, const Camera& camera, std::int64_t number);

// ViewMessage::map: `map` for a client that was last sent `before`, or nothing yet (null). Lines are few, and sent
// whole.
std::string mapMessage(const ViewedMap& map, const ViewedMap* before);

}  // namespace edgeslam
