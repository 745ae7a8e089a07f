// Where a camera that was lost can be.
#include "places/reach.h"

#include <gtest/gtest.h>

#include <initializer_list>

namespace edgeslam {
namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

void addKeyframe(int world, double seconds, double x, Map& map) {
  Keyframe keyframe;
  keyframe.id = static_cast<KeyframeId>(map.keyframes.size());
  keyframe.world = world;
  keyframe.time_ns = static_cast<std::int64_t>(seconds * second_ns);
  keyframe.world_T_camera.translation = {x, 0, 0};
  map.keyframes.push_back(keyframe);
}

TEST(ReachableFrom, GrowsWithTimeAndNeverBelowAStep) {
  Map map;
  for (const int k : {0, 1, 2, 3}) addKeyframe(0, 0.5 * k, 0.1 * k * k, map);  // the last step: 0.5 in half a second
  const Pose last = map.keyframes.back().world_T_camera;
  EXPECT_DOUBLE_EQ(reachableFrom(map, last, 0).distance, 0.5);
  EXPECT_NEAR(reachableFrom(map, last, 3).distance, 2 * 1.0 * 3, 1e-9);
  EXPECT_EQ(reachableFrom(map, last, 3).centre, last.translation);
}

TEST(ReachableFrom, PosesThatErrFromFrameToFrameAreNoSpeed) {
  Map map;
  for (int k = 0; k < 60; ++k) addKeyframe(0, k / 30.0, 0.01 * k + (k % 2 == 0 ? 0.02 : 0), map);  // 0.3 a second
  EXPECT_LT(reachableFrom(map, Pose(), 10).distance, 2 * 0.4 * 10);
}

TEST(ReachableFrom, WhatLiesBetweenRunsOrInOtherWorldsIsNoMotion) {
  Map map;
  for (const int k : {0, 1, 2}) addKeyframe(0, k, 0.1 * k, map);
  addKeyframe(1, 3, 50, map);
  addKeyframe(0, 100, 30, map);
  addKeyframe(0, 2, 90, map);  // of a run that began anew
  EXPECT_NEAR(reachableFrom(map, Pose(), 10).distance, 2 * 0.1 * 10, 1e-9);
}

// World 0 moves on by 1 a second for 4 s. World 1, of half the unit, is begun a second later.
Map twoWorlds() {
  Map map;
  for (const int k : {0, 1, 2, 3, 4}) addKeyframe(0, k, k, map);
  for (const int k : {0, 1, 2}) addKeyframe(1, 5 + k, 2 * k, map);
  return map;
}

WorldJoin joinAt(double x) { return {1, 0, {0.5, Eigen::Quaterniond::Identity(), {x, 0, 0}}}; }

TEST(OutOfReach, WorldsAreOneOnlyWhereTheCameraCanHaveComeMeanwhile) {
  const Map map = twoWorlds();
  EXPECT_EQ(outOfReach(map, joinAt(5)), "");
  EXPECT_EQ(outOfReach(map, joinAt(4 + 1.9)), "");
  EXPECT_EQ(outOfReach(map, joinAt(4 - 1.9)), "");
  EXPECT_NE(outOfReach(map, joinAt(4 + 2.1)), "");
  EXPECT_EQ(outOfReach(map, joinAt(4 - 2.1)),
            "the camera would have come by 2.10 in 1.00 s while it was lost, it can by 2.00");
}

TEST(OutOfReach, EachTimeThatTheCameraCameFromOneToTheOtherCounts) {
  Map map = twoWorlds();
  addKeyframe(0, 8, 40, map);  // back in world 0
  EXPECT_NE(outOfReach(map, joinAt(5)), "");
}

TEST(OutOfReach, WorldsBetweenGiveMoreTime) {
  Map map;
  for (const int k : {0, 1, 2}) addKeyframe(0, k, k, map);
  for (const int k : {0, 1, 2}) addKeyframe(2, 3 + k, 100, map);
  for (const int k : {0, 1}) addKeyframe(1, 6 + k, 2 * k, map);
  EXPECT_EQ(outOfReach(map, joinAt(2 + 7.9)), "");
  EXPECT_NE(outOfReach(map, joinAt(2 + 8.1)), "");
}

TEST(OutOfReach, TimesOfOtherRunsSayNothing) {
  Map map;
  for (const int k : {0, 1, 2}) addKeyframe(0, 100 + k, k, map);
  for (const int k : {0, 1, 2}) addKeyframe(1, k, k, map);
  EXPECT_EQ(outOfReach(map, joinAt(1000)), "");
}

}  // namespace
}  // namespace edgeslam
