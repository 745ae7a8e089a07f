#include "map/map_cropping.h"

#include <gtest/gtest.h>

#include <limits>

#include "map/map_check.h"
#include "map/worlds.h"
#include "unit/map/made_map.h"
#include "unit/map/same_map.h"

namespace edgeslam::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Keyframes one map unit apart along x, that look along z; each hosts a point 5 units ahead, which the two after it see
// too. The second half is another world.
SavedMap rowOfKeyframes(int count, bool two_worlds = false) {
  SavedMap saved = madeMap(64, 48);
  Map map;
  for (KeyframeId id = 0; id < count; ++id) {
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.world = two_worlds && 2 * id >= count ? 1 : 0;
    keyframe.world_T_camera.translation.x() = id;
    for (KeyframeId host = std::max(0, id - 2); host <= id; ++host) {
      if (host > 0 && map.keyframes.contains(host) && map.keyframes[host].world != keyframe.world) continue;
      keyframe.observations.push_back(madeObservation(host, id, 64, 48));
    }
    map.keyframes.push_back(keyframe);
    MapPoint point;
    point.id = point.host = point.chain_keyframe = id;
    point.host_bearing = Eigen::Vector3d::UnitZ();
    point.inverse_depth = 0.2;
    map.points.emplace(id, point);
  }
  for (const Keyframe& keyframe : map.keyframes) {
    for (const PointObservation& observation : keyframe.observations) {
      MapPoint& point = map.points.at(observation.point);
      if (point.host != keyframe.id && map.keyframes[point.host].world == keyframe.world) {
        point.seen_in.push_back(keyframe.id);
      }
    }
  }
  for (auto point = map.points.begin(); point != map.points.end();) {
    point = point->second.seen_in.empty() ? map.points.erase(point) : std::next(point);
  }
  saved.map = map;
  EXPECT_EQ(mapProblem(saved.camera, saved.map), "");
  return saved;
}

MapBox between(double least_x, double most_x) {
  return {{least_x, -infinity, -infinity}, {most_x, infinity, infinity}};
}

TEST(MapBox, HoldsItsBounds) {
  const MapBox box{{0, 0, 0}, {1, 2, infinity}};
  EXPECT_TRUE(box.holds({0, 2, 1e9}));
  EXPECT_FALSE(box.holds({0, 2.1, 0}));
  EXPECT_FALSE(box.holds({0, 0, -1e-9}));
}

TEST(CropMap, TakesOutWhatLiesInABoxAndNothingElse) {
  SavedMap saved = rowOfKeyframes(20);
  MapCropping cropping;
  cropping.removed_boxes = {between(4.5, 9.5)};
  const Map before = saved.map;
  const RemovedParts removed = cropMap(cropping, saved.map);
  EXPECT_EQ(mapProblem(saved.camera, saved.map), "");
  EXPECT_EQ(removed.keyframes, before.keyframes.size() - saved.map.keyframes.size());
  EXPECT_EQ(removed.points, before.points.size() - saved.map.points.size());
  for (const Keyframe& keyframe : saved.map.keyframes) EXPECT_TRUE(keyframe.id < 5 || keyframe.id > 9) << keyframe.id;
  for (const auto& [id, point] : saved.map.points) {
    const Eigen::Vector3d position = worldPosition(saved.map, point);
    EXPECT_TRUE(position.x() < 4.5 || position.x() > 9.5);
    EXPECT_LT((position - worldPosition(before, before.points.at(id))).norm(), 1e-12) << "coordinates stay";
  }
  for (const KeyframeId id : {0, 3, 11, 19}) {
    ASSERT_TRUE(saved.map.keyframes.contains(id));
    EXPECT_EQ(saved.map.keyframes[id].world_T_camera.translation, before.keyframes[id].world_T_camera.translation);
  }
}

// What is kept by a box is what is not taken out by it.
TEST(CropMap, KeepsWhatLiesInABox) {
  SavedMap saved = rowOfKeyframes(20);
  MapCropping cropping;
  cropping.kept = between(4.5, 9.5);
  cropMap(cropping, saved.map);
  EXPECT_EQ(mapProblem(saved.camera, saved.map), "");
  EXPECT_GE(saved.map.keyframes.size(), 4U);
  for (const Keyframe& keyframe : saved.map.keyframes) EXPECT_TRUE(keyframe.id >= 5 && keyframe.id <= 9);
  EXPECT_GE(saved.map.points.size(), 3U);
}

TEST(CropMap, TakesOutKeyframesAndWhatOnlyTheySaw) {
  SavedMap saved = rowOfKeyframes(20);
  MapCropping cropping;
  cropping.removed_keyframes = {{0, 3}, {18, 99}};
  cropMap(cropping, saved.map);
  EXPECT_EQ(mapProblem(saved.camera, saved.map), "");
  EXPECT_EQ(saved.map.keyframes.front().id, 4);
  EXPECT_EQ(saved.map.keyframes.back().id, 17);
  EXPECT_FALSE(saved.map.points.count(2));
  EXPECT_TRUE(saved.map.points.count(3)) << "keyframes 4 and 5 see it";
}

TEST(CropMap, BoxesAreOfOneWorld) {
  SavedMap saved = rowOfKeyframes(20, true);
  MapCropping cropping;
  cropping.world = 1;
  cropping.removed_boxes = {between(-infinity, infinity)};
  cropMap(cropping, saved.map);
  EXPECT_EQ(worldsOf(saved.map), std::vector<int>{0});
  EXPECT_GE(saved.map.keyframes.size(), 9U);
}

TEST(CropMap, TakesOutAWorld) {
  SavedMap saved = rowOfKeyframes(20, true);
  MapCropping cropping;
  cropping.removed_worlds = {0};
  cropMap(cropping, saved.map);
  EXPECT_EQ(mapProblem(saved.camera, saved.map), "");
  EXPECT_EQ(worldsOf(saved.map), std::vector<int>{1});
}

TEST(CropMap, ABoxBesideItChangesNothing) {
  SavedMap saved = rowOfKeyframes(20);
  const std::string before = encodeMap(saved);
  MapCropping cropping;
  cropping.removed_boxes = {between(100, 200)};
  const RemovedParts removed = cropMap(cropping, saved.map);
  EXPECT_EQ(removed.keyframes + removed.points + removed.lines, 0U);
  EXPECT_TRUE(encodeMap(saved) == before);
}

}  // namespace
}  // namespace edgeslam::test
