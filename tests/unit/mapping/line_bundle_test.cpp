// Lines in adjustments of keyframes: they stand for the points on them, bring keyframes to where they are, and are
// dissolved where their views contradict.
#include "mapping/line_bundle.h"

#include <gtest/gtest.h>

#include "geometry/angles.h"
#include "line_scene.h"
#include "mapping/local_adjustment.h"
#include "unit/map/change_each.h"

namespace edgeslam::test {
namespace {

double offItsLine(const Map& map, PointId id) {
  const SpaceLine line = lineThrough(zigzag_edges[static_cast<std::size_t>(id / 100)]);
  const Eigen::Vector3d position = worldPosition(map, map.points.at(id));
  return (closestPoint(line, position) - position).norm();
}

TEST(LineBundle, PointsOnLinesAreThoseThatMostKeyframesSeeThere) {
  Random random(1);
  Map map = mapOfPanels({}, random);
  std::vector<KeyframeId> all;
  for (const Keyframe& keyframe : map.keyframes) all.push_back(keyframe.id);
  const std::map<PointId, LineId> on_lines = pointsOnLines(map, all);
  EXPECT_EQ(on_lines.size(), map.points.size());
  for (const auto& [point, line] : on_lines) EXPECT_EQ(line, point / 100);

  map.points.at(trackOf(0, 0)).corner = true;
  for (const KeyframeId keyframe : {1, 2, 3}) {  // three of five see it elsewhere
    test::changeEach(map.keyframes[keyframe].observations, [&](PointObservation& seen) {
      if (seen.point == trackOf(0, 1)) seen.straight_edge = 2;
    });
  }
  map.lines.at(3).is_placed = false;
  const std::map<PointId, LineId> fewer = pointsOnLines(map, all);
  EXPECT_EQ(fewer.count(trackOf(0, 0)), 0U);
  EXPECT_EQ(fewer.at(trackOf(0, 1)), 2);
  EXPECT_EQ(fewer.count(trackOf(3, 0)), 0U);
  EXPECT_EQ(fewer.size(), on_lines.size() - 1 - tracks_on_edge);
}

// A keyframe that sees a line takes part though none of the given ones is near it.
TEST(LineBundle, AllKeyframesThatSeeALineTakePart) {
  Random random(1);
  const Map map = mapOfPanels({}, random);
  BundleProblem problem;
  std::vector<KeyframeId> cameras;
  const auto cameraOf = [&](KeyframeId keyframe) {
    const auto found = std::find(cameras.begin(), cameras.end(), keyframe);
    if (found == cameras.end()) cameras.push_back(keyframe);
    return static_cast<int>(std::find(cameras.begin(), cameras.end(), keyframe) - cameras.begin());
  };
  const LinesInBundle added = addLines({4}, map, cameraOf, problem);
  EXPECT_EQ(added.lines.size(), zigzag_edges.size());
  EXPECT_EQ(added.line_of_point.size(), map.points.size());
  EXPECT_EQ(cameras.size(), 5U);
  std::size_t views = 0;
  for (const auto& [id, line] : map.lines) views += line.seen_in.size();
  EXPECT_EQ(problem.line_observations.size(), 2 * views);
}

// The bare scene: points whose depths are wrong, and poses that are off, come right by the lines alone.
TEST(LineBundle, BringsPosesAndPointsToTheirPlaces) {
  Random random(2);
  Map map = mapOfPanels({}, random);
  const Map truth = map;
  for (Keyframe& keyframe : map.keyframes) {
    if (keyframe.id > 0) keyframe.world_T_camera = perturbed(random, keyframe.world_T_camera, 0.01, 0.005);
  }
  for (auto& [id, point] : map.points) point.inverse_depth *= uniform(random, 0.9, 1.1);
  LocalAdjustmentOptions options;
  options.bundle.iterations = 30;
  ASSERT_TRUE(adjustKeyframes(distorted_camera, options, {0, 1, 2, 3, 4}, {}, map));
  EXPECT_EQ(map.lines.size(), zigzag_edges.size());
  // The gauge of scale keeps the distance of the farthest keyframe as it was put.
  const auto centre = [](const Map& of, KeyframeId id) { return of.keyframes[id].world_T_camera.translation; };
  const double scale = centre(map, 4).norm() / centre(truth, 4).norm();
  for (KeyframeId id = 1; id < 5; ++id) {
    EXPECT_LT((centre(map, id) - scale * centre(truth, id)).norm(), 2e-4) << id;
    EXPECT_LT(map.keyframes[id].world_T_camera.rotation.angularDistance(truth.keyframes[id].world_T_camera.rotation),
              1e-4);
  }
  for (const auto& [id, point] : map.points) {
    const Eigen::Vector3d there = scale * worldPosition(truth, truth.points.at(id));
    EXPECT_LT((worldPosition(map, point) - there).norm(), 0.01) << id;
    EXPECT_LT(point.inverse_depth_sigma, 0.05 * point.inverse_depth);
  }
}

TEST(LineBundle, PutsPointsOnTheirLines) {
  Random random(3);
  Map map = mapOfPanels({}, random);
  for (auto& [id, point] : map.points) {
    point.inverse_depth *= 1.1;
    ASSERT_GT(offItsLine(map, id), 0.01);
  }
  ASSERT_TRUE(adjustKeyframes(distorted_camera, {}, {2, 3, 4}, {0, 1}, map));
  for (const auto& [id, point] : map.points) EXPECT_LT(offItsLine(map, id), 1e-3) << id;
}

TEST(LineBundle, DissolvesALineThatItsViewsContradict) {
  Random random(4);
  Map map = mapOfPanels({}, random);
  const std::size_t points = map.points.size();
  contradictViewsOf(6, map);
  ASSERT_TRUE(adjustKeyframes(distorted_camera, {}, {2, 3, 4}, {0, 1}, map));
  EXPECT_EQ(map.lines.count(6), 0U);
  EXPECT_EQ(map.lines.size(), zigzag_edges.size() - 1);
  EXPECT_EQ(map.points.size(), points);  // which are points again
  for (const Keyframe& keyframe : map.keyframes) {
    for (const SeenEdge& edge : keyframe.straight_edges) EXPECT_NE(edge.line, 6);
  }
}

TEST(LineBundle, DissolvesTheEdgeOfADoorThatOpens) {
  Random random(6);
  EdgeSight sight;
  sight.noise = 0.3;
  Map map = mapOfPanels(sight, random, 8);
  const double width = 0.6;
  for (Keyframe& keyframe : map.keyframes) {
    const double opened = radians(5) * std::max(0, keyframe.id - 3);
    const Eigen::Vector3d moved(width * (1 - std::cos(opened)), 0, -width * std::sin(opened));
    const Pose camera_T_world = keyframe.world_T_camera.inverse();
    for (SeenEdge& edge : keyframe.straight_edges) {
      if (edge.line != 0) continue;
      edge.from = endAt(distorted_camera, project(distorted_camera, camera_T_world * (zigzag_edges[0].from + moved)));
      edge.to = endAt(distorted_camera, project(distorted_camera, camera_T_world * (zigzag_edges[0].to + moved)));
    }
  }
  ASSERT_TRUE(adjustKeyframes(distorted_camera, {}, {2, 3, 4, 5, 6, 7}, {0, 1}, map));
  EXPECT_EQ(map.lines.count(0), 0U);
  EXPECT_EQ(map.lines.size(), zigzag_edges.size() - 1);                                 // which outvoted it
  ASSERT_TRUE(adjustKeyframes(distorted_camera, {}, {2, 3, 4, 5, 6, 7}, {0, 1}, map));  // as with the next keyframe
  const Pose truth = poseAt(0.08 * 7, 0.02, 0.03, {0.07, -0.14, 0});
  EXPECT_LT((map.keyframes.back().world_T_camera.translation - truth.translation).norm(), 0.02);
}

TEST(LineBundle, SameBytesTwice) {
  Random random(5);
  EdgeSight sight;
  sight.noise = 1;
  const Map map = mapOfPanels(sight, random);
  Map first = map, second = map;
  ASSERT_TRUE(adjustKeyframes(distorted_camera, {}, {2, 3, 4}, {0, 1}, first));
  ASSERT_TRUE(adjustKeyframes(distorted_camera, {}, {2, 3, 4}, {0, 1}, second));
  for (const auto& [id, line] : first.lines) {
    EXPECT_EQ(line.in_host.point, second.lines.at(id).in_host.point);
    EXPECT_EQ(line.in_host.direction, second.lines.at(id).in_host.direction);
  }
  for (const Keyframe& keyframe : first.keyframes) {
    EXPECT_EQ(keyframe.world_T_camera.translation, second.keyframes[keyframe.id].world_T_camera.translation);
  }
}

}  // namespace
}  // namespace edgeslam::test
