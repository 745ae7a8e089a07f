// Two maps of one room, each with a frame, a unit and numbers of its own, become one; of two rooms they do not.
#include "pipeline/map_joining.h"

#include <gtest/gtest.h>

#include <cmath>

#include "edgeslam/input_error.h"
#include "map/map_check.h"
#include "map/worlds.h"
#include "unit/places/made_place.h"

namespace edgeslam::test {
namespace {

constexpr int keyframes_around = 36;

std::vector<Pose> around(int first, int count, double aside = 0) {
  std::vector<Pose> poses;
  for (int k = first; k < first + count; ++k) {
    const double angle = 2 * M_PI * k / keyframes_around;
    Pose pose;
    pose.rotation = rotationExp({0, angle, 0});
    pose.translation = 0.6 * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle)) + Eigen::Vector3d(aside, -aside, 0);
    poses.push_back(pose);
  }
  return poses;
}

// As it is known to itself: its first keyframe is at the origin, and its unit another one.
Map inItsOwnFrame(Map map, double scale) {
  const Similarity own{scale, map.keyframes.front().world_T_camera.inverse().rotation,
                       scale * map.keyframes.front().world_T_camera.inverse().translation};
  joinWorlds({map.keyframes.front().world, 0, own}, map);
  return map;
}

void renumber(int world, Map& map) {
  Map renumbered;
  for (Keyframe keyframe : map.keyframes) {
    keyframe.world = world;
    renumbered.keyframes.push_back(keyframe);
  }
  map.keyframes = renumbered.keyframes;
}

TEST(JoinMap, TwoMapsOfOneRoomBecomeOne) {
  const std::vector<Pose> first = around(0, 16), second = around(8, 16, 0.05);
  Map map = makePlace(7, placeCamera(), first);
  const Map added = inItsOwnFrame(makePlace(7, placeCamera(), second), 2.5);
  const std::size_t points = map.points.size() + added.points.size();
  const MapJoining joining = joinMap(placeCamera(), Settings(), added, map);
  ASSERT_TRUE(joining.is_joined) << joining.found << " found, " << joining.agreeing << " agree";
  EXPECT_EQ(joining.keyframes, 32);
  EXPECT_GE(joining.agreeing + static_cast<std::size_t>(joining.loops), 1U);
  EXPECT_EQ(mapProblem(placeCamera(), map), "");
  EXPECT_EQ(worldsOf(map), std::vector<int>{0});
  EXPECT_EQ(map.keyframes.size(), 32U);
  EXPECT_GT(map.points.size(), points * 9 / 10);
  std::vector<Pose> truth = first;
  truth.insert(truth.end(), second.begin(), second.end());
  std::vector<Eigen::Vector3d> is, should_be;
  std::size_t k = 0;
  for (const Keyframe& keyframe : map.keyframes) {
    is.push_back(keyframe.world_T_camera.translation);
    should_be.push_back(truth[k++].translation);
  }
  const Similarity aligned = alignHorn(is, should_be);
  for (std::size_t i = 0; i < is.size(); ++i) EXPECT_LT((aligned * is[i] - should_be[i]).norm(), 0.06) << i;
  EXPECT_NEAR(aligned.scale, 1, 0.05) << "the unit is the first one's";
}

TEST(JoinMap, TheMapOfAnotherRoomIsRefusedAndNothingChanges) {
  Map map = makePlace(7, placeCamera(), around(0, 12));
  const Map before = map, added = makePlace(8, placeCamera(), around(0, 12));
  const MapJoining joining = joinMap(placeCamera(), Settings(), added, map);
  EXPECT_FALSE(joining.is_joined);
  EXPECT_EQ(joining.keyframes, 24);
  EXPECT_EQ(joining.agreeing, 0U);
  EXPECT_EQ(joining.loops, 0);
  ASSERT_EQ(map.keyframes.size(), before.keyframes.size());
  EXPECT_EQ(map.points.size(), before.points.size());
  for (const Keyframe& keyframe : map.keyframes) {
    EXPECT_EQ(keyframe.world_T_camera.translation, before.keyframes[keyframe.id].world_T_camera.translation);
  }
}

TEST(JoinMap, NumbersThatAreTooLargeTogetherAreRefused) {
  Map map = makePlace(7, placeCamera(), around(0, 2));
  Map added = map;
  Keyframe last = added.keyframes.back();
  last.id = largest_keyframe_id;
  added.keyframes.push_back(last);
  EXPECT_THROW(joinMap(placeCamera(), Settings(), added, map), InputError);
  Map many_worlds = map;
  renumber(largest_keyframe_id, many_worlds);
  EXPECT_THROW(joinMap(placeCamera(), Settings(), many_worlds, map), InputError);
  EXPECT_EQ(map.keyframes.size(), 2U);
}

}  // namespace
}  // namespace edgeslam::test
