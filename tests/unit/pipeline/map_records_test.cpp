#include "pipeline/map_records.h"

#include <gtest/gtest.h>

#include "unit/mapping/edge_scene.h"

namespace edgeslam {
namespace {

Map mapOfEdges() {
  test::Random random(4);
  const test::EdgeScene scene = test::framesOnAWall(40);
  const std::vector<Pose> poses{Pose(), {Eigen::Quaterniond::Identity(), {0.4, 0, 0}}};
  Map map = test::keyframesOf(test::distorted_camera, scene, poses, test::Sight(), random);
  test::addAllPoints(scene, map);
  return map;
}

TEST(MapRecords, EveryPointOnceInTheOrderOfItsEdge) {
  const Map map = mapOfEdges();
  const auto records = mapPointRecords(map, test::distorted_camera);
  ASSERT_EQ(records.size(), map.points.size());
  for (std::size_t i = 1; i < records.size(); ++i) {
    EXPECT_GE(records[i].chain, records[i - 1].chain);
    if (records[i].chain == records[i - 1].chain) {
      EXPECT_GT(records[i].order, records[i - 1].order);
    } else {
      EXPECT_EQ(records[i].chain, records[i - 1].chain + 1);
    }
  }
}

TEST(MapRecords, DirectionsRunAlongTheEdges) {
  const test::EdgeScene scene = test::framesOnAWall(40);
  const auto records = mapPointRecords(mapOfEdges(), test::distorted_camera);
  int directed = 0;
  for (const MapPointRecord& record : records) {
    if (record.edge_direction.norm() == 0) continue;
    ++directed;
    EXPECT_NEAR(record.edge_direction.norm(), 1, 1e-9);
    double best = 0, nearest = HUGE_VAL;
    for (const auto& point : scene.points) {
      const double distance = (point.position - record.position).norm();
      if (distance > nearest) continue;
      nearest = distance;
      best = std::abs(point.direction.dot(record.edge_direction));
    }
    EXPECT_GT(best, 0.999);
  }
  EXPECT_GT(directed, 0.9 * static_cast<double>(records.size()));
}

TEST(MapRecords, LinesGoFromEndToEndOfWhatWasSeen) {
  Map map = mapOfEdges();
  for (Keyframe& keyframe : map.keyframes) keyframe.world = 2;
  MapLine line;
  line.id = 5;
  line.host = 1;
  line.in_host = {{0, 0, 3}, Eigen::Vector3d::UnitY()};
  line.begin = -1;
  line.end = 0.5;
  line.seen_in = {0, 1};
  map.lines.emplace(5, line);
  EXPECT_TRUE(mapLineRecords(map).empty()) << "it is not placed";
  map.lines.at(5).is_placed = true;
  const auto records = mapLineRecords(map);
  ASSERT_EQ(records.size(), 1U);
  EXPECT_LT((records[0].from - Eigen::Vector3d(0.4, -1, 3)).norm(), 1e-12);
  EXPECT_LT((records[0].to - Eigen::Vector3d(0.4, 0.5, 3)).norm(), 1e-12);
  EXPECT_EQ(records[0].id, 5);
  EXPECT_EQ(records[0].keyframes, 2);
  EXPECT_EQ(records[0].world, 2);
}

TEST(MapRecords, EdgesOfDifferentKeyframesAreDifferentEdges) {
  Map map;
  for (const KeyframeId host : {0, 1}) {
    Keyframe keyframe;
    keyframe.id = host;
    map.keyframes.push_back(keyframe);
    for (int k = 0; k < 3; ++k) {
      MapPoint point;
      point.id = 10 * host + k;
      point.host = host;
      point.host_bearing = Eigen::Vector3d(0.1 * k, 0, 1).normalized();
      point.inverse_depth = 0.5;
      point.inverse_depth_sigma = 0.05;
      point.chain_keyframe = host;
      point.chain = 7;  // the number that it has in its keyframe
      point.order = k;
      map.points.emplace(point.id, point);
    }
  }
  const auto records = mapPointRecords(map, test::distorted_camera);
  ASSERT_EQ(records.size(), 6U);
  EXPECT_EQ(records[0].chain, records[2].chain);
  EXPECT_NE(records[2].chain, records[3].chain);
  EXPECT_FLOAT_EQ(records[0].depth_sigma_ratio, 0.1f);
}

TEST(MapRecords, KeyframesTellHowManyMapPointsTheySee) {
  Map map = mapOfEdges();
  map.keyframes[1].reason = "rotation";
  const auto records = keyframeRecords(map);
  ASSERT_EQ(records.size(), 2U);
  EXPECT_EQ(records[1].id, 1);
  EXPECT_EQ(records[1].frame_index, 10);
  EXPECT_EQ(records[1].reason, "rotation");
  EXPECT_EQ(records[1].shared_points, static_cast<int>(map.points.size()));
  map.points.erase(map.points.begin());
  EXPECT_EQ(keyframeRecords(map)[1].shared_points, static_cast<int>(map.points.size()));
}

}  // namespace
}  // namespace edgeslam
