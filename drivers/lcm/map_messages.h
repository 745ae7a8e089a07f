// The map's points and lines as messages that each fit into one packet.
#pragma once

#include <vector>

#include "drivers/lcm/body_pose.h"
#include "edgeslam/map_lines_t.hpp"
#include "edgeslam/map_part_t.hpp"

namespace edgeslam {

struct PublishedPoint {
  PointId id = 0;
  Eigen::Vector3f position = Eigen::Vector3f::Zero();   // world, map units
  Eigen::Vector3f direction = Eigen::Vector3f::Zero();  // of the edge, world, unit; zero for a corner-like point
};

struct PublishedLine {
  LineId id = 0;
  // Its ends: world, map units. From one to the other the brighter side is on the left, as seen from where it was seen.
  Eigen::Vector3f from = Eigen::Vector3f::Zero(), to = Eigen::Vector3f::Zero();
};

struct PublishedMap {
  std::vector<PublishedPoint> points;
  std::vector<PublishedLine> lines;
};

// Without the points and lines that are not finite.
PublishedMap finiteMap(PublishedMap map);

// Number of parts that so many points or lines come in; at least 1, which says that there are none.
int numberOfPointParts(std::size_t points);
int numberOfLineParts(std::size_t lines);

// Part `part`, counted from 0, of the points' numberOfPointParts() or the lines' numberOfLineParts().
map_part_t pointPart(const std::vector<PublishedPoint>& points, int part, std::int64_t version, std::int64_t utime,
                     const RobotSetup& robot);
map_lines_t linePart(const std::vector<PublishedLine>& lines, int part, std::int64_t version, std::int64_t utime,
                     const RobotSetup& robot);

}  // namespace edgeslam
