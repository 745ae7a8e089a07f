// P18: points that keyframes share, and what tracking sees of the map.
#include "map/map.h"

#include <gtest/gtest.h>

#include "map/map_view.h"

namespace edgeslam {
namespace {

Keyframe keyframeSeeing(KeyframeId id, const std::vector<PointId>& points) {
  Keyframe keyframe;
  keyframe.id = id;
  for (const PointId point : points) {
    PointObservation observation;
    observation.point = point;
    observation.order = static_cast<int>(10 * point + id);
    keyframe.observations.push_back(observation);
  }
  return keyframe;
}

MapPoint pointOf(PointId id, KeyframeId host, std::vector<KeyframeId> seen_in) {
  MapPoint point;
  point.id = id;
  point.host = host;
  point.host_bearing = Eigen::Vector3d(0.6, 0, 0.8);
  point.inverse_depth = 0.25;
  point.seen_in = std::move(seen_in);
  return point;
}

Map threeKeyframes() {
  Map map;
  map.keyframes = {keyframeSeeing(0, {2, 3, 5, 7}), keyframeSeeing(1, {3, 5, 7, 11}), keyframeSeeing(2, {5, 11, 13})};
  map.points.emplace(3, pointOf(3, 0, {1}));
  map.points.emplace(5, pointOf(5, 0, {1, 2}));
  map.points.emplace(11, pointOf(11, 1, {2}));
  return map;
}

TEST(Map, FindsAnObservationByItsPoint) {
  const Keyframe keyframe = keyframeSeeing(4, {2, 3, 5, 7});
  for (const PointId point : {2, 3, 5, 7}) {
    const PointObservation* found = findObservation(keyframe, point);
    ASSERT_NE(found, nullptr) << point;
    EXPECT_EQ(found->order, 10 * point + 4);
  }
  for (const PointId point : {-1, 0, 4, 6, 8}) EXPECT_EQ(findObservation(keyframe, point), nullptr) << point;
  EXPECT_EQ(findObservation(Keyframe(), 0), nullptr);
}

TEST(Map, TheFirstFreePointIsBeyondAllThatWereSeen) {
  EXPECT_EQ(firstFreePoint(Map()), 0);
  EXPECT_EQ(firstFreePoint(threeKeyframes()), 14);
}

TEST(Map, CountsSharedPointsByHostsAndViewsAndNotTracksWithoutDepth) {
  const Map map = threeKeyframes();
  EXPECT_EQ(sharedPoints(map, 0), (std::vector<int>{0, 2, 1}));
  EXPECT_EQ(sharedPoints(map, 1), (std::vector<int>{2, 0, 2}));
  EXPECT_EQ(sharedPoints(map, 2), (std::vector<int>{1, 2, 0}));
}

TEST(Map, TheSceneIsAsFarAsTheMedianOfThePointsSeen) {
  Map map = threeKeyframes();
  map.points.at(3).inverse_depth = 0.5;
  map.points.at(5).inverse_depth = 0.1;
  EXPECT_NEAR(sceneDistance(map, map.keyframes[1]), 4, 1e-12);  // of 2, 4 and 10
  EXPECT_EQ(sceneDistance(map, map.keyframes[1], 4), 0);
  EXPECT_EQ(sceneDistance(Map(), map.keyframes[1]), 0);
}

TEST(Map, APointLiesAlongItsHostsBearing) {
  Map map = threeKeyframes();
  map.keyframes[1].world_T_camera = {rotationExp({0, M_PI / 2, 0}), {1, 2, 3}};
  // (0.6, 0, 0.8) * 4 in the camera; a quarter turn about y takes z to x and x to -z.
  EXPECT_LT((worldPosition(map, map.points.at(11)) - Eigen::Vector3d(1 + 3.2, 2, 3 - 2.4)).norm(), 1e-12);
  EXPECT_LT((worldPosition(map, map.points.at(3)) - Eigen::Vector3d(2.4, 0, 3.2)).norm(), 1e-12);
}

TEST(MapView, FindsPointsAndPlacesThemAsTheMapDoes) {
  MapView view;
  view.keyframes = {{0, Pose(), nullptr}, {1, {rotationExp({0, M_PI / 2, 0}), {1, 2, 3}}, nullptr}};
  for (const PointId id : {3, 8, 20}) {
    ViewPoint point;
    point.id = id;
    point.host = 1;
    point.host_bearing = Eigen::Vector3d(0.6, 0, 0.8);
    point.inverse_depth = 0.25;
    view.points.push_back(point);
  }
  ASSERT_NE(findPoint(view, 8), nullptr);
  EXPECT_EQ(findPoint(view, 8)->id, 8);
  for (const PointId id : {0, 4, 21}) EXPECT_EQ(findPoint(view, id), nullptr) << id;
  EXPECT_LT((worldPosition(view, view.points[0]) - Eigen::Vector3d(4.2, 2, 0.6)).norm(), 1e-12);
}

TEST(MapView, AFlatViewPutsEveryPointOfTheFirstFrameAtDistanceOne) {
  TrackedFrame first;
  first.frame_index = 17;
  for (const PointId id : {4, 6, 9}) {
    PointObservation observation;
    observation.point = id;
    observation.bearing = Eigen::Vector3d(0.1 * static_cast<double>(id), -0.2, 1).normalized();
    first.observations.push_back(observation);
  }
  const MapView view = flatView(first);
  EXPECT_FALSE(view.initialised);
  EXPECT_NE(view.waiting_for, "");
  EXPECT_EQ(view.origin_frame, 17);
  ASSERT_EQ(view.points.size(), 3U);
  for (const PointObservation& observation : first.observations) {
    const ViewPoint* point = findPoint(view, observation.point);
    ASSERT_NE(point, nullptr);
    EXPECT_NEAR(worldPosition(view, *point).norm(), 1, 1e-12);
    EXPECT_LT((worldPosition(view, *point) - observation.bearing).norm(), 1e-12);
    EXPECT_GT(point->inverse_depth_sigma, 0);
  }
}

}  // namespace
}  // namespace edgeslam
