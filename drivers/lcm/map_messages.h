// The map's points as messages that each fit into one packet.
#pragma once

#include <vector>

#include "drivers/lcm/body_pose.h"
#include "edgeslam/map_part_t.hpp"

namespace edgeslam {

struct PublishedPoint {
  PointId id = 0;
  Eigen::Vector3f position = Eigen::Vector3f::Zero();   // world, map units
  Eigen::Vector3f direction = Eigen::Vector3f::Zero();  // of the edge, world, unit; zero for a corner-like point
};

// Without the points that are not finite.
std::vector<PublishedPoint> finitePoints(std::vector<PublishedPoint> points);

// Number of parts that so many points come in; at least 1.
int numberOfMapParts(std::size_t points);

// Part `part`, counted from 0, of the points' numberOfMapParts().
map_part_t mapPart(const std::vector<PublishedPoint>& points, int part, std::int64_t version, std::int64_t utime,
                   const ScaleState& scale);

}  // namespace edgeslam
