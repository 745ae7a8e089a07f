// What is in a map, in figures: a row for each of its worlds.
#pragma once

#include <cstdint>
#include <vector>

#include "map/map.h"

namespace edgeslam {

struct MapExtent {
  Eigen::Vector3d least = Eigen::Vector3d::Zero(), most = Eigen::Vector3d::Zero();  // world [map units]
};

struct WorldFigures {
  int world = 0;
  std::size_t keyframes = 0, keyframes_with_images = 0, points = 0, lines = 0;  // lines that are placed
  KeyframeId first = 0, last = 0;
  std::int64_t first_ns = 0, last_ns = 0;  // the earliest and the latest of their times
  double way = 0;                          // of the camera, from keyframe to keyframe [map units]
  MapExtent cameras;
  MapExtent most_points;  // where all but a hundredth of the points lie on either side; 0 where there are none
};

// In the order of the worlds' numbers.
std::vector<WorldFigures> figuresOf(const Map& map);

}  // namespace edgeslam
