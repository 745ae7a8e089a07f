// What tracking gets to see of the map: what is near, and nothing of what is not.
#include "mapping/view_of_map.h"

#include <gtest/gtest.h>

#include <utility>

namespace edgeslam {
namespace {

// `count` keyframes in a row along x, one map unit apart, looking along z; each hosts one point 5 units ahead that the
// next keyframe sees too.
Map rowOfKeyframes(int count) {
  Map map;
  for (KeyframeId id = 0; id < count; ++id) {
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.world_T_camera.translation.x() = id;
    keyframe.images = std::make_shared<FrameImages>();
    if (id > 0) {
      PointObservation seen;
      seen.point = id - 1;
      keyframe.observations.push_back(seen);
    }
    PointObservation hosted;
    hosted.point = id;
    keyframe.observations.push_back(hosted);
    map.keyframes.push_back(keyframe);
    MapPoint point;
    point.id = id;
    point.host = id;
    point.host_bearing = Eigen::Vector3d::UnitZ();
    point.inverse_depth = 0.2;
    if (id + 1 < count) point.seen_in = {id + 1};
    map.points.emplace(id, std::move(point));
  }
  return map;
}

bool has(const MapView& view, PointId id) { return findPoint(view, id) != nullptr; }

TEST(ViewOfMap, ShowsAllPosesAndThePointsOfTheLatestKeyframes) {
  const Map map = rowOfKeyframes(40);
  const MapView view = viewOfMap(map, 39, ViewOptions());
  ASSERT_EQ(view.keyframes.size(), 40u);
  EXPECT_EQ(view.keyframes[17].world_T_camera.translation.x(), 17);
  EXPECT_TRUE(has(view, 39));
  EXPECT_TRUE(has(view, 32));
  EXPECT_FALSE(has(view, 5)) << "far behind";
  for (const ViewPoint& point : view.points) {
    ASSERT_GE(point.source, 0);
    EXPECT_TRUE(view.keyframes[point.source].images);
  }
}

TEST(ViewOfMap, OldKeyframesAtTheSamePlaceAreInItToo) {
  Map map = rowOfKeyframes(40);
  map.keyframes.back().world_T_camera = map.keyframes[3].world_T_camera;  // back at an old place
  const MapView view = viewOfMap(map, 39, ViewOptions());
  EXPECT_TRUE(has(view, 3));
  EXPECT_FALSE(has(view, 20));
  map.keyframes.back().world_T_camera.rotation = Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitY());  // looking elsewhere
  EXPECT_FALSE(has(viewOfMap(map, 39, ViewOptions()), 3));
}

TEST(ViewOfMap, TheCentreCanBeAnOldKeyframe) {
  const Map map = rowOfKeyframes(40);
  const MapView view = viewOfMap(map, 6, ViewOptions());
  EXPECT_TRUE(has(view, 6));
  EXPECT_FALSE(has(view, 38));
}

// What keyframes 5 and 6 saw is found again by 5 from where 5 is, and by 6 from where 6 is.
TEST(ViewOfMap, SourcesCanBeTheNearestKeyframesRatherThanTheLatest) {
  const Map map = rowOfKeyframes(40);
  ViewOptions nearest;
  nearest.nearest_sources = true;
  EXPECT_EQ(findPoint(viewOfMap(map, 5, ViewOptions()), 5)->source, 6);
  EXPECT_EQ(findPoint(viewOfMap(map, 5, nearest), 5)->source, 5);
  EXPECT_EQ(findPoint(viewOfMap(map, 6, nearest), 5)->source, 6);
  for (const ViewPoint& point : viewOfMap(map, 6, nearest).points) EXPECT_GE(point.source, 0);
}

TEST(ViewOfMap, SaysWhatItIsAround) {
  EXPECT_EQ(viewOfMap(rowOfKeyframes(40), 6, ViewOptions()).centre, 6);
  EXPECT_EQ(MapView().centre, -1);
}

}  // namespace
}  // namespace edgeslam
