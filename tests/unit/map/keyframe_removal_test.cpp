#include "map/keyframe_removal.h"

#include <gtest/gtest.h>

#include "map/map_check.h"
#include "unit/map/made_map.h"

namespace edgeslam::test {
namespace {

TEST(RemoveKeyframe, LeavesAMapInAnyOrder) {
  for (const std::vector<KeyframeId>& order :
       {std::vector<KeyframeId>{0, 1, 4, 9}, {9, 4, 1, 0}, {4, 0, 9, 1}, {1, 9, 0, 4}}) {
    SavedMap saved = madeMap(64, 48);
    saved.map.points.erase(3);  // that only its host sees
    for (const KeyframeId id : order) {
      removeKeyframe(id, saved.map);
      EXPECT_FALSE(saved.map.keyframes.contains(id));
      EXPECT_EQ(mapProblem(saved.camera, saved.map), "");
      for (const auto& [number, point] : saved.map.points) EXPECT_FALSE(point.seen_in.empty()) << number;
    }
    EXPECT_TRUE(saved.map.points.empty());
    EXPECT_TRUE(saved.map.lines.empty());
  }
}

TEST(RemoveKeyframe, WhatOthersSeeStaysWhereItIs) {
  SavedMap saved = madeMap(64, 48);
  const Map before = saved.map;
  removeKeyframe(4, saved.map);  // it hosts all points, and line 3
  ASSERT_TRUE(saved.map.points.count(5));
  const MapPoint &was = before.points.at(5), &is = saved.map.points.at(5);
  EXPECT_LT((worldPosition(before, was) - worldPosition(saved.map, is)).norm(), 1e-12);
  EXPECT_EQ(is.host, 0);
  EXPECT_EQ(is.seen_in, (std::vector<KeyframeId>{1, 9}));
  EXPECT_FALSE(saved.map.points.count(3)) << "no other keyframe saw it";
  ASSERT_TRUE(saved.map.lines.count(3));
  EXPECT_EQ(saved.map.lines.at(3).host, 0);
  const SpaceLine line_was = inWorld(before, before.lines.at(3)), line_is = inWorld(saved.map, saved.map.lines.at(3));
  EXPECT_LT((line_was.point - line_is.point).norm(), 1e-12);
  EXPECT_LT((line_was.direction - line_is.direction).norm(), 1e-12);
  EXPECT_FALSE(saved.map.lines.count(8));
}

}  // namespace
}  // namespace edgeslam::test
