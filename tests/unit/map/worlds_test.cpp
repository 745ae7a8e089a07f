// Worlds in one map: told apart, forgotten, joined.
#include "map/worlds.h"

#include <gtest/gtest.h>

#include "unit/adjustment/synthetic_scene.h"
#include "unit/map/seen_line.h"

namespace edgeslam {
namespace {

void addKeyframe(KeyframeId id, int world, const Eigen::Vector3d& position, Map& map) {
  Keyframe keyframe;
  keyframe.id = id;
  keyframe.world = world;
  keyframe.world_T_camera = {rotationExp({0.1 * id, 0, 0.2}), position};
  map.keyframes.push_back(keyframe);
}

void addPoint(PointId id, KeyframeId host, std::vector<KeyframeId> seen_in, Map& map) {
  MapPoint point;
  point.id = id;
  point.host = host;
  point.host_bearing = Eigen::Vector3d(0.1, -0.2, 1).normalized();
  point.inverse_depth = 0.25;
  point.inverse_depth_sigma = 0.01;
  point.seen_in = std::move(seen_in);
  map.points.emplace(id, point);
}

// Keyframes 0, 1 and 7 in world 0, to which the camera came back; 3 to 5 in world 2.
Map twoWorlds() {
  const Camera camera = test::testCamera(CameraModel::pinhole_radial_tangential);
  Map map;
  addKeyframe(0, 0, {0, 0, 0}, map);
  addKeyframe(1, 0, {1, 0, 0}, map);
  for (const KeyframeId id : {3, 4, 5}) addKeyframe(id, 2, {0, 1.0 * id, 0}, map);
  addKeyframe(7, 0, {2, 0, 0}, map);
  addPoint(10, 0, {1, 7}, map);
  addPoint(20, 3, {4, 5}, map);
  addPoint(21, 5, {4}, map);
  test::addSeenLine(camera, 30, {0, 7}, map);
  test::addSeenLine(camera, 31, {4, 5}, map);
  return map;
}

TEST(Worlds, AreToldApart) {
  const Map map = twoWorlds();
  EXPECT_EQ(worldsOf(map), (std::vector<int>{0, 2}));
  EXPECT_EQ(keyframesOf(map, 0), (std::vector<KeyframeId>{0, 1, 7}));
  EXPECT_EQ(keyframesOf(map, 2), (std::vector<KeyframeId>{3, 4, 5}));
  EXPECT_TRUE(keyframesOf(map, 1).empty());
  EXPECT_TRUE(worldsOf(Map()).empty());
}

TEST(Worlds, HaveAFirstAndALatestKeyframe) {
  const Map map = twoWorlds();
  EXPECT_EQ(firstKeyframeOf(map, 0), 0);
  EXPECT_EQ(latestKeyframeOf(map, 0), 7);
  EXPECT_EQ(firstKeyframeOf(map, 2), 3);
  EXPECT_EQ(latestKeyframeOf(map, 2), 5);
  EXPECT_EQ(firstKeyframeOf(map, 1), -1);
  EXPECT_EQ(latestKeyframeOf(map, 1), -1);
}

TEST(Worlds, TheKeyframeBeforeIsOfTheSameWorld) {
  const Map map = twoWorlds();
  EXPECT_EQ(keyframeBefore(map, 7), 1);
  EXPECT_EQ(keyframeBefore(map, 4), 3);
  EXPECT_EQ(keyframeBefore(map, 3), -1);
  EXPECT_EQ(keyframeBefore(map, 0), -1);
}

TEST(Worlds, OneCanBeForgotten) {
  Map map = twoWorlds();
  forgetWorld(map, 2);
  EXPECT_EQ(worldsOf(map), std::vector<int>{0});
  EXPECT_EQ(map.points.size(), 1U);
  EXPECT_EQ(map.points.count(10), 1U);
  EXPECT_EQ(map.lines.size(), 1U);
  EXPECT_EQ(map.lines.count(30), 1U);
}

TEST(Worlds, WhatWasBegunLastCanBeForgotten) {
  Map map = twoWorlds();
  map.keyframes.erase(7);
  map.points.at(10).seen_in = {1};
  EXPECT_FALSE(forgetFrom(map, 6));
  EXPECT_TRUE(forgetFrom(map, 3));
  EXPECT_EQ(map.keyframes.back().id, 1);
  EXPECT_EQ(map.points.size(), 1U);
  EXPECT_FALSE(forgetFrom(map, 3));
}

TEST(Worlds, JoinedTheYoungerIsPartOfTheOlder) {
  const Map before = twoWorlds();
  Map map = before;
  const WorldJoin join{2, 0, {1.7, Eigen::Quaterniond(rotationExp({0.3, -0.2, 0.5})), {4, 5, 6}}};
  joinWorlds(join, map);
  EXPECT_EQ(worldsOf(map), std::vector<int>{0});
  for (const auto& [id, point] : map.points) {
    const Eigen::Vector3d was = worldPosition(before, before.points.at(id));
    const Eigen::Vector3d should_be = id < 20 ? was : Eigen::Vector3d(join.to_S_from * was);
    EXPECT_LT((worldPosition(map, point) - should_be).norm(), 1e-12) << id;
    EXPECT_NEAR(point.inverse_depth_sigma / point.inverse_depth, 0.04, 1e-12) << id;
  }
  for (const auto& [id, line] : map.lines) {
    const double scale = id == 30 ? 1 : join.to_S_from.scale;
    const SpaceLine was = inWorld(before, before.lines.at(id)), is = inWorld(map, line);
    for (const double along : {-0.5, 0.0, 1.5}) {
      const Eigen::Vector3d point = was.point + along * was.direction;
      const Eigen::Vector3d should_be = id == 30 ? point : Eigen::Vector3d(join.to_S_from * point);
      EXPECT_LT((is.point + scale * along * is.direction - should_be).norm(), 1e-12) << id;
    }
    EXPECT_NEAR(line.begin, -0.5 * scale, 1e-12);
    EXPECT_NEAR(line.end, 1.5 * scale, 1e-12);
  }
  for (const KeyframeId id : {0, 1, 7}) {
    EXPECT_EQ(map.keyframes[id].world_T_camera.translation, before.keyframes[id].world_T_camera.translation);
  }
}

}  // namespace
}  // namespace edgeslam
