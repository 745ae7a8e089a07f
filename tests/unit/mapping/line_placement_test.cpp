// Lines are placed where their views agree, not before these show them from sides that differ enough, and never where
// they contradict.
#include "mapping/line_placement.h"

#include <gtest/gtest.h>

#include "geometry/angles.h"
#include "line_scene.h"

namespace edgeslam::test {
namespace {

const std::vector<SpaceEdge> two_borders{{{-1.0, -0.6, 3}, {-1.0, 0.6, 3}}, {{0.5, 0.7, 3.2}, {0.3, -0.6, 3.6}}};

// Lines that keyframes at these poses see, as association leaves them.
Map unplaced(const std::vector<Pose>& poses, const EdgeSight& sight = {}) {
  Random random(3);
  Map map;
  for (const Pose& pose : poses) {
    const auto id = static_cast<KeyframeId>(map.keyframes.size());
    map.keyframes.push_back(keyframeThatSees(distorted_camera, two_borders, id, pose, sight, random));
  }
  addPlacedLines(two_borders, map);
  for (auto& [id, line] : map.lines) {
    line.is_placed = false;
    line.in_host = {};
    line.begin = line.end = 0;
  }
  return map;
}

// 0.1 m at 3 m are 1.9 degrees between the planes of two neighbours.
const std::vector<Pose> side_by_side{poseAt(0, 0, 0), poseAt(0.1, 0, 0), poseAt(0.2, 0.05, 0)};

// How far the line of an edge is off at its ends [map units].
double offEnds(const Map& map, std::size_t edge) {
  const SpaceLine line = inWorld(map, map.lines.at(static_cast<LineId>(edge)));
  double off = 0;
  for (const Eigen::Vector3d& end : {two_borders[edge].from, two_borders[edge].to}) {
    off = std::max(off, (closestPoint(line, end) - end).norm());
  }
  return off;
}

TEST(LinePlacement, FindsLinesWhereTheyAre) {
  Map map = unplaced(side_by_side);
  placeLines(distorted_camera, {}, map);
  ASSERT_EQ(map.lines.size(), two_borders.size());
  for (std::size_t i = 0; i < two_borders.size(); ++i) {
    const MapLine& line = map.lines.at(static_cast<LineId>(i));
    ASSERT_TRUE(line.is_placed);
    EXPECT_LT(offEnds(map, i), 1e-6);
    EXPECT_NEAR(line.end - line.begin, (two_borders[i].to - two_borders[i].from).norm(), 1e-6);
    const double along = inWorld(map, line).direction.dot((two_borders[i].to - two_borders[i].from).normalized());
    EXPECT_NEAR(along, 1, 1e-9);  // and not the opposite: the brighter side is told
  }
}

TEST(LinePlacement, ErrsAsTheNoiseDoes) {
  EdgeSight sight;
  sight.noise = 1;
  Map map =
      unplaced({poseAt(0, 0, 0), poseAt(0.1, 0, 0), poseAt(0.2, 0.05, 0), poseAt(0.3, 0, 0), poseAt(0.4, 0, 0)}, sight);
  placeLines(distorted_camera, {}, map);
  for (std::size_t i = 0; i < two_borders.size(); ++i) {
    ASSERT_TRUE(map.lines.at(static_cast<LineId>(i)).is_placed);
    // 0.1 px at a parallax of 0.4 m, 53 px: some 0.2 % of 3 m.
    EXPECT_LT(offEnds(map, i), 0.02);
  }
}

TEST(LinePlacement, WaitsForThreeKeyframes) {
  Map map = unplaced({poseAt(0, 0, 0), poseAt(0.3, 0, 0)});
  placeLines(distorted_camera, {}, map);
  ASSERT_EQ(map.lines.size(), two_borders.size());
  for (const auto& [id, line] : map.lines) EXPECT_FALSE(line.is_placed);
}

TEST(LinePlacement, WaitsForParallax) {
  const Map seen = unplaced(side_by_side);
  LineOptions options;
  for (const double least : {3.0, 6.0}) {
    Map map = seen;
    options.least_parallax_deg = least;
    placeLines(distorted_camera, options, map);
    for (const auto& [id, line] : map.lines) EXPECT_EQ(line.is_placed, least < 4) << least;
  }
  // Along a line there is none, however far the camera goes; nor where it turns on the spot.
  for (const std::vector<Pose>& poses :
       {std::vector<Pose>{poseAt(0, 0, 0), poseAt(0, 0.15, 0), poseAt(0, 0.3, 0)},
        std::vector<Pose>{poseAt(0, 0, 0), poseAt(0, 0, 0, {0, 0.1, 0}), poseAt(0, 0, 0, {0.1, 0.05, 0.2})}}) {
    Map map = unplaced(poses);
    placeLines(distorted_camera, {}, map);
    EXPECT_FALSE(map.lines.at(0).is_placed);
  }
}

TEST(LinePlacement, RefusesViewsThatContradict) {
  const Map seen = unplaced({poseAt(0, 0, 0), poseAt(0.1, 0, 0), poseAt(0.2, 0.05, 0), poseAt(0.3, 0, 0)});
  for (const double off_px : {0.05, 3.0}) {
    Map map = seen;
    // Every other view is beside where it should be: of two lines, that is, or of a moving one.
    for (Keyframe& keyframe : map.keyframes) {
      for (SeenEdge& edge : keyframe.straight_edges) {
        if (edge.line != 0) continue;
        const Eigen::Vector2d off(keyframe.id % 2 == 0 ? off_px : -off_px, 0);
        edge.from = endAt(distorted_camera, edge.from.pixel + off);
        edge.to = endAt(distorted_camera, edge.to.pixel + off);
      }
    }
    placeLines(distorted_camera, {}, map);
    EXPECT_EQ(map.lines.at(0).is_placed, off_px < 1) << off_px;
    EXPECT_TRUE(map.lines.at(1).is_placed);
  }
}

TEST(LinePlacement, RefusesALineThatSeemsBehindTheCamera) {
  Map map = unplaced(side_by_side);
  // As if the camera had gone the other way.
  for (Keyframe& keyframe : map.keyframes) keyframe.world_T_camera.translation *= -1;
  placeLines(distorted_camera, {}, map);
  for (const auto& [id, line] : map.lines) EXPECT_FALSE(line.is_placed);
}

TEST(LinePlacement, ForgetsWhatWasNeverPlaced) {
  Map map = unplaced({poseAt(0, 0, 0), poseAt(0.1, 0, 0)});
  for (KeyframeId id = 2; id < 6; ++id) {
    Keyframe keyframe;
    keyframe.id = id;
    map.keyframes.push_back(keyframe);
    placeLines(distorted_camera, {}, map);
    EXPECT_EQ(map.lines.empty(), id == 5) << id;
  }
  EXPECT_TRUE(map.lines.empty());
  for (const Keyframe& keyframe : map.keyframes) {
    for (const SeenEdge& edge : keyframe.straight_edges) EXPECT_EQ(edge.line, -1);
  }
}

}  // namespace
}  // namespace edgeslam::test
