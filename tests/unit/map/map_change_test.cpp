// P20, P27: what was done to a copy of the map, applied to the same map and to one that has grown since.
#include "map/map_change.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/camera.h"
#include "map/map_check.h"
#include "unit/adjustment/synthetic_scene.h"
#include "unit/map/same_map.h"
#include "unit/map/seen_line.h"

namespace edgeslam::test {
namespace {

const Camera camera = testCamera(CameraModel::pinhole_radial_tangential);
constexpr int landmarks = 60;

Eigen::Vector3d landmark(int i) {
  Random random(static_cast<std::uint64_t>(100 + i));
  return {uniform(random, -2, 2), uniform(random, -1.5, 1.5), uniform(random, 4, 7)};
}

Pose poseOf(KeyframeId id) {
  Random random(static_cast<std::uint64_t>(7 + id));
  return perturbed(random, Pose{Eigen::Quaterniond::Identity(), {0.1 * id, 0, 0}}, 0.05, 0.02);
}

PointObservation observationOf(PointId point, const Pose& world_T_camera, const Eigen::Vector3d& position) {
  PointObservation observation;
  observation.point = point;
  const Eigen::Vector3d seen = world_T_camera.inverse() * position;
  observation.measurement = {project(camera, seen), {1, 0}, 0.2, 0.2};
  observation.bearing = bearing(camera, observation.measurement.pixel);
  observation.corner = true;
  return observation;
}

// Adds keyframe `id` and with it the points of which it is the second view: point i is first seen by keyframe i / 10,
// and by all later ones.
void grow(KeyframeId id, const Pose& world_T_camera, Map& map) {
  Keyframe keyframe;
  keyframe.id = id;
  keyframe.frame_index = 10 * id;
  keyframe.world_T_camera = world_T_camera;
  for (int i = 0; i < landmarks && i < 10 * (id + 1); ++i) {
    keyframe.observations.push_back(observationOf(i, poseOf(id), landmark(i)));
    const auto found = map.points.find(i);
    if (found != map.points.end()) found->second.seen_in.push_back(id);
  }
  map.keyframes.push_back(keyframe);
  for (int i = 10 * (id - 1); i < landmarks && i < 10 * id; ++i) {
    MapPoint point;
    point.id = i;
    point.host = id - 1;
    const Eigen::Vector3d in_host = poseOf(point.host).inverse() * landmark(i);
    point.host_bearing = findObservation(map.keyframes[point.host], i)->bearing;
    point.inverse_depth = 1 / in_host.norm();
    point.inverse_depth_sigma = 0.02 * point.inverse_depth;
    point.corner = true;
    point.seen_in = {id};
    map.points.emplace(i, point);
  }
}

Map madeMapOf(int keyframes) {
  Map map;
  map.keyframes.push_back(Keyframe());
  Keyframe& first = map.keyframes.back();
  first.world_T_camera = poseOf(0);
  for (int i = 0; i < 10; ++i) first.observations.push_back(observationOf(i, poseOf(0), landmark(i)));
  for (KeyframeId id = 1; id < keyframes; ++id) grow(id, poseOf(id), map);
  return map;
}

// The whole map in another world, exactly.
void moveAll(const Similarity& move, Map& map) {
  for (Keyframe& keyframe : map.keyframes) {
    keyframe.world_T_camera = {(move.rotation * keyframe.world_T_camera.rotation).normalized(),
                               move * keyframe.world_T_camera.translation};
  }
  for (auto& [id, point] : map.points) {
    point.inverse_depth /= move.scale;
    point.inverse_depth_sigma /= move.scale;
  }
  for (auto& [id, line] : map.lines) {
    line.in_host.point *= move.scale;
    line.begin *= move.scale;
    line.end *= move.scale;
  }
}

// What an adjustment with a closed loop leaves: other poses and depths, views taken out and views found, points erased.
Map adjusted(const Map& before) {
  Random random(11);
  Map after = before;
  for (Keyframe& keyframe : after.keyframes) {
    if (keyframe.id > 0) keyframe.world_T_camera = perturbed(random, keyframe.world_T_camera, 0.1, 0.05);
  }
  for (auto& [id, point] : after.points) {
    point.inverse_depth *= uniform(random, 0.8, 1.2);
    point.inverse_depth_sigma *= uniform(random, 0.5, 1.0);
    if (id % 7 == 3 && point.seen_in.size() > 1) point.seen_in.erase(point.seen_in.begin());
  }
  for (const PointId id : {PointId{4}, PointId{15}, PointId{16}}) after.points.erase(id);
  // Point 35 found in keyframe 1, which had not seen it.
  after.points.at(35).seen_in.insert(after.points.at(35).seen_in.begin(), 1);
  SharedList<PointObservation>& observations = after.keyframes[1].observations;
  observations.insert(std::lower_bound(observations.begin(), observations.end(), PointId{35},
                                       [](const PointObservation& o, PointId wanted) { return o.point < wanted; }),
                      observationOf(35, poseOf(1), landmark(35)));
  return after;
}

Eigen::Vector3d positionOf(const Map& map, PointId id) { return worldPosition(map, map.points.at(id)); }

Eigen::Vector3d inCamera(const Map& map, KeyframeId keyframe, PointId point) {
  return map.keyframes[keyframe].world_T_camera.inverse() * positionOf(map, point);
}

// Newer keyframes and what is hosted in them are to each other, and to the copy's latest keyframe, as they were.
void expectSameAmongNewer(const Map& was, const Map& is, KeyframeId latest, double scale) {
  for (const Keyframe& a : was.keyframes) {
    for (const Keyframe& b : was.keyframes) {
      if (a.id < latest || b.id < latest) continue;
      const Pose was_a_T_b = a.world_T_camera.inverse() * b.world_T_camera;
      const Pose is_a_T_b = is.keyframes[a.id].world_T_camera.inverse() * is.keyframes[b.id].world_T_camera;
      EXPECT_LT((is_a_T_b.translation - scale * was_a_T_b.translation).norm(), 1e-9) << a.id << ", " << b.id;
      EXPECT_LT(rotationAngle(is_a_T_b.rotation, was_a_T_b.rotation), 1e-7) << a.id << ", " << b.id;
    }
  }
  int reprojected = 0;
  for (const auto& [id, point] : was.points) {
    if (point.host <= latest) continue;
    for (const KeyframeId keyframe : point.seen_in) {
      const Eigen::Vector3d was_seen = inCamera(was, keyframe, id), is_seen = inCamera(is, keyframe, id);
      EXPECT_LT((is_seen - scale * was_seen).norm(), 1e-9) << id;
      EXPECT_LT((project(camera, is_seen) - project(camera, was_seen)).norm(), 1e-6) << id;
      ++reprojected;
    }
  }
  EXPECT_GT(reprojected, 10);
}

TEST(MapChange, AppliedToTheSameMapItGivesTheMapAfter) {
  const Map before = madeMapOf(6), after = adjusted(before);
  ASSERT_EQ(mapProblem(camera, before), "");
  ASSERT_EQ(mapProblem(camera, after), "");
  ASSERT_LT(after.points.size(), before.points.size());
  const MapChange change = changeOf(before, after);
  EXPECT_EQ(change.erased_points, (std::vector<PointId>{4, 15, 16}));
  EXPECT_FALSE(change.erased_views.empty());
  EXPECT_EQ(change.added_views.size(), 1U);
  Map is = before;
  applyChange(change, is);
  expectSame({camera, after}, {camera, is});
}

TEST(MapChange, AppliedTwiceItGivesTheSame) {
  const Map before = madeMapOf(6), after = adjusted(before);
  const MapChange change = changeOf(before, after);
  Map is = before;
  applyChange(change, is);
  applyChange(change, is);
  expectSame({camera, after}, {camera, is});
}

TEST(MapChange, OfNothingItLeavesAGrownMapWhereItIs) {
  const Map before = madeMapOf(4), grown = madeMapOf(6);
  const MapChange change = changeOf(before, before);
  EXPECT_TRUE(change.erased_points.empty() && change.erased_views.empty() && change.added_views.empty());
  Map is = grown;
  applyChange(change, is);
  ASSERT_EQ(is.points.size(), grown.points.size());
  for (const Keyframe& keyframe : grown.keyframes) {
    EXPECT_LT((is.keyframes[keyframe.id].world_T_camera.translation - keyframe.world_T_camera.translation).norm(),
              1e-12);
  }
  for (const auto& [id, point] : grown.points) {
    EXPECT_LT((positionOf(is, id) - worldPosition(grown, point)).norm(), 1e-9) << id;
    EXPECT_EQ(is.points.at(id).seen_in, point.seen_in);
  }
}

TEST(MapChange, AnEmptyOneDoesNothing) {
  const Map before = madeMapOf(4);
  EXPECT_TRUE(MapChange().empty());
  EXPECT_TRUE(changeOf(Map(), Map()).empty());
  EXPECT_FALSE(changeOf(before, before).empty());
  Map is = before;
  applyChange(MapChange(), is);
  expectSame({camera, before}, {camera, is});
}

class MapChangeScaled : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Scale, MapChangeScaled, testing::Values(1.0, 0.7, 1.6));

TEST_P(MapChangeScaled, AMoveOfTheWholeCopyMovesAllThatCameSince) {
  const double scale = GetParam();
  const Similarity move{scale, rotationExp({0.3, -0.5, 0.9}), {2, -1, 4}};
  Map before = madeMapOf(4), grown = madeMapOf(6);
  for (Map* map : {&before, &grown}) {
    addSeenLine(camera, 3, {0, 2}, *map);
    addSeenLine(camera, 4, {1, 3}, *map);
  }
  addSeenLine(camera, 7, {4, 5}, grown);
  // Line 4 got another host since.
  const SpaceLine in_world = inWorld(grown, grown.lines.at(4));
  grown.lines.at(4).host = 3;
  setInWorld(in_world, grown, grown.lines.at(4));
  Map after = before, should_be = grown;
  moveAll(move, after);
  moveAll(move, should_be);
  const MapChange change = changeOf(before, after);
  EXPECT_NEAR(change.newer_S_world.scale, scale, 1e-9);
  Map is = grown;
  applyChange(change, is);
  ASSERT_EQ(is.keyframes.size(), 6U);
  for (const Keyframe& keyframe : should_be.keyframes) {
    const Pose& pose = is.keyframes[keyframe.id].world_T_camera;
    EXPECT_LT((pose.translation - keyframe.world_T_camera.translation).norm(), 1e-9) << keyframe.id;
    EXPECT_LT(rotationAngle(pose.rotation, keyframe.world_T_camera.rotation), 1e-7) << keyframe.id;
  }
  ASSERT_EQ(is.points.size(), should_be.points.size());
  for (const auto& [id, point] : should_be.points) {
    EXPECT_LT((positionOf(is, id) - worldPosition(should_be, point)).norm(), 1e-8) << id;
    EXPECT_NEAR(is.points.at(id).inverse_depth_sigma, point.inverse_depth_sigma, 1e-9) << id;
    EXPECT_EQ(is.points.at(id).seen_in, point.seen_in) << id;
  }
  ASSERT_EQ(is.lines.size(), 3U);
  for (const auto& [id, line] : should_be.lines) {
    EXPECT_LT((is.lines.at(id).in_host.point - line.in_host.point).norm(), 1e-9) << id;
    EXPECT_NEAR(is.lines.at(id).begin, line.begin, 1e-9) << id;
    EXPECT_NEAR(is.lines.at(id).end, line.end, 1e-9) << id;
  }
  EXPECT_EQ(mapProblem(camera, is), "");
}

TEST(MapChange, LinesAreWhereTheCorrectionPutThemOrGone) {
  Map before = madeMapOf(4);
  addSeenLine(camera, 3, {0, 2}, before);
  addSeenLine(camera, 4, {1, 3}, before);
  Map after = before;
  MapLine& moved = after.lines.at(3);
  moved.in_host = {{0.2, -0.3, 6}, Eigen::Vector3d(1, 1, 0).normalized()};
  moved.begin = -1;
  moved.end = 2;
  dissolveLine(4, after);
  Map is = before;
  applyChange(changeOf(before, after), is);
  ASSERT_EQ(is.lines.size(), 1U);
  const MapLine& line = is.lines.at(3);
  EXPECT_EQ(line.in_host.point, moved.in_host.point);
  EXPECT_EQ(line.in_host.direction, moved.in_host.direction);
  EXPECT_EQ(line.begin, -1);
  EXPECT_EQ(line.end, 2);
  for (const Keyframe& keyframe : is.keyframes) {
    for (const SeenEdge& edge : keyframe.straight_edges) EXPECT_NE(edge.line, 4);
  }
  EXPECT_EQ(mapProblem(camera, is), "");
}

TEST(MapChange, WhatCameSinceGoesAlongWithTheLatestKeyframeHoweverTheOthersMoved) {
  const KeyframeId latest = 3;
  const Map before = madeMapOf(latest + 1), grown = madeMapOf(7);
  // Drift shared out: each keyframe, and what is hosted in it, moves more than the one before.
  Map after = before;
  const auto moveOf = [](KeyframeId id) {
    return Similarity{std::pow(1.1, id), rotationExp({0, 0.05 * id, 0.02 * id}), {0.1 * id, 0.2 * id, 0}};
  };
  for (Keyframe& keyframe : after.keyframes) {
    const Similarity move = moveOf(keyframe.id);
    keyframe.world_T_camera = {(move.rotation * keyframe.world_T_camera.rotation).normalized(),
                               move * keyframe.world_T_camera.translation};
  }
  for (auto& [id, point] : after.points) point.inverse_depth /= moveOf(point.host).scale;
  const MapChange change = changeOf(before, after);
  Map is = grown;
  applyChange(change, is);
  for (KeyframeId id = 0; id <= latest; ++id) {
    EXPECT_EQ(is.keyframes[id].world_T_camera.translation, after.keyframes[id].world_T_camera.translation);
  }
  EXPECT_GT(change.newer_S_world.scale, 1.05);
  expectSameAmongNewer(grown, is, latest, change.newer_S_world.scale);
  EXPECT_EQ(mapProblem(camera, is), "");
}

// As if keyframe 1 were culled: its points are hosted in keyframe 2, the others that it saw forget it.
void takeOutKeyframe1(Map& map) {
  for (auto& [id, point] : map.points) {
    if (point.host == 1) {
      const Eigen::Vector3d seen = map.keyframes[2].world_T_camera.inverse() * worldPosition(map, point);
      const double relative_sigma = point.inverse_depth_sigma / point.inverse_depth;
      point.host = 2;
      point.host_bearing = seen.normalized();
      point.inverse_depth = 1 / seen.norm();
      point.inverse_depth_sigma = relative_sigma * point.inverse_depth;
      point.seen_in.erase(point.seen_in.begin());
    } else if (point.seen_in.front() == 1) {
      point.seen_in.erase(point.seen_in.begin());
    }
  }
  map.keyframes.erase(1);
}

TEST(MapChange, APointThatLostItsHostSinceKeepsToItsPlaceInTheMovedMap) {
  const double scale = 1.3;
  const Similarity move{scale, rotationExp({0.2, 0.1, -0.4}), {-1, 5, 2}};
  const Map before = madeMapOf(5);
  Map after = before;
  moveAll(move, after);
  Map grown = madeMapOf(6);
  takeOutKeyframe1(grown);
  ASSERT_EQ(mapProblem(camera, grown), "");
  const Map was = grown;
  applyChange(changeOf(before, after), grown);
  EXPECT_EQ(mapProblem(camera, grown), "");
  EXPECT_FALSE(grown.keyframes.contains(1));
  ASSERT_EQ(grown.points.size(), was.points.size());
  for (const auto& [id, point] : was.points) {
    EXPECT_LT((positionOf(grown, id) - move * worldPosition(was, point)).norm(), 1e-8) << id;
    EXPECT_EQ(grown.points.at(id).host, point.host);
  }
}

TEST(MapChange, APointThatLostItsHostSinceIsAsMuchFartherAsItWasFromItsHost) {
  const Map before = madeMapOf(5);
  Map after = before;
  for (auto& [id, point] : after.points) point.inverse_depth /= 1 + 0.01 * static_cast<double>(id);
  Map map = before;
  takeOutKeyframe1(map);
  const Map was = map;
  applyChange(changeOf(before, after), map);
  int elsewhere = 0;
  for (const auto& [id, point] : was.points) {
    if (before.points.at(id).host != 1) continue;
    ++elsewhere;
    const double farther = 1 + 0.01 * static_cast<double>(id);
    EXPECT_NEAR(map.points.at(id).inverse_depth, point.inverse_depth / farther, 1e-12) << id;
    EXPECT_NEAR(map.points.at(id).inverse_depth_sigma, point.inverse_depth_sigma / farther, 1e-12) << id;
  }
  EXPECT_EQ(elsewhere, 10);
}

TEST(MapChange, WhatIsNoLongerThereIsPassedOver) {
  const Map before = madeMapOf(6), after = adjusted(before);
  const MapChange change = changeOf(before, after);
  Map map = before;
  map.points.erase(35);  // in the copy it was found in keyframe 1
  map.points.erase(15);  // in the copy it was erased
  map.points.erase(20);
  Map should_be = after;
  should_be.points.erase(35);
  should_be.points.erase(20);
  applyChange(change, map);
  EXPECT_EQ(mapProblem(camera, map), "");
  ASSERT_EQ(map.points.size(), should_be.points.size());
  for (const auto& [id, point] : should_be.points) expectSamePoint(point, map.points.at(id));
}

TEST(MapChange, AViewInAKeyframeThatIsGoneIsNotAdded) {
  const Map before = madeMapOf(6), after = adjusted(before);
  Map map = before;
  // Keyframe 1 was culled, with all that needed it.
  for (auto point = map.points.begin(); point != map.points.end();) {
    std::vector<KeyframeId>& seen_in = point->second.seen_in;
    seen_in.erase(std::remove(seen_in.begin(), seen_in.end(), 1), seen_in.end());
    point = point->second.host == 1 || seen_in.empty() ? map.points.erase(point) : std::next(point);
  }
  map.keyframes.erase(1);
  ASSERT_EQ(mapProblem(camera, map), "");
  applyChange(changeOf(before, after), map);
  EXPECT_EQ(mapProblem(camera, map), "");
  EXPECT_EQ(map.points.at(35).seen_in, before.points.at(35).seen_in);
}

TEST(MapChange, APointWhoseLastViewWasAnOutlierIsGoneUnlessItWasSeenSince) {
  const Map before = madeMapOf(4);
  Map after = before;
  ASSERT_EQ(before.points.at(20).seen_in, (std::vector<KeyframeId>{3}));
  // In the copy there is another view left; the map has lost that one by itself.
  ASSERT_EQ(before.points.at(10).seen_in, (std::vector<KeyframeId>{2, 3}));
  after.points.at(10).seen_in = {3};
  after.points.at(11).seen_in = {3};
  const MapChange change = changeOf(before, after);
  EXPECT_EQ(change.erased_views, (std::vector<std::pair<PointId, KeyframeId>>{{10, 2}, {11, 2}}));
  Map map = madeMapOf(5);
  map.points.at(10).seen_in = {2};
  map.points.at(11).seen_in = {2, 4};
  applyChange(change, map);
  EXPECT_EQ(map.points.count(10), 0U);
  EXPECT_EQ(map.points.at(11).seen_in, (std::vector<KeyframeId>{4}));
  EXPECT_EQ(map.points.at(20).seen_in, (std::vector<KeyframeId>{3, 4}));
  EXPECT_EQ(mapProblem(camera, map), "");
}

TEST(MapChange, AViewAddedWhereThePointIsHostedByNowIsNone) {
  const Map before = madeMapOf(6), after = adjusted(before);
  const MapChange change = changeOf(before, after);
  Map map = before;
  MapPoint& point = map.points.at(35);
  point.host = 1;  // the copy found it there
  applyChange(change, map);
  EXPECT_EQ(point.host, 1);
  EXPECT_EQ(std::count(point.seen_in.begin(), point.seen_in.end(), 1), 0);
}

TEST(MapChange, WithoutPointsTheScaleIsOne) {
  Map before = madeMapOf(4);
  before.points.clear();
  Map after = before;
  moveAll({1, rotationExp({0.1, 0, 0}), {0, 0, 3}}, after);
  Map grown = madeMapOf(5);
  grown.points.clear();
  applyChange(changeOf(before, after), grown);
  EXPECT_LT(
      (grown.keyframes[4].world_T_camera.translation -
       (after.keyframes[3].world_T_camera * (before.keyframes[3].world_T_camera.inverse() * poseOf(4).translation)))
          .norm(),
      1e-9);
}

// The copy's keyframes 3 and 4 are of world 1, which turns out to be part of world 0; keyframe 5 came since, and 6 is
// of a world that was begun since.
TEST(MapChange, WorldsThatWereJoinedTakeAlongWhatCameSince) {
  Map copy = madeMapOf(5);
  const WorldJoin join{1, 0, {2, Eigen::Quaterniond(rotationExp({0, 0.4, 0})), {1, 2, 3}}};
  for (auto point = copy.points.begin(); point != copy.points.end();) {
    std::vector<KeyframeId>& seen_in = point->second.seen_in;
    const bool is_old = point->second.host < 3;
    seen_in.erase(std::remove_if(seen_in.begin(), seen_in.end(), [&](KeyframeId id) { return (id < 3) != is_old; }),
                  seen_in.end());
    point = seen_in.empty() ? copy.points.erase(point) : std::next(point);
  }
  for (const KeyframeId id : {3, 4}) copy.keyframes[id].world = 1;
  Map corrected = copy;
  joinWorlds(join, corrected);
  Map grown = copy;
  for (const auto& [id, world] : {std::pair{5, 1}, std::pair{6, 2}}) {
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.world = world;
    keyframe.world_T_camera = poseOf(id);
    grown.keyframes.push_back(keyframe);
  }
  applyChange(changeOf(copy, corrected, join), grown);
  for (const KeyframeId id : {0, 1, 2, 3, 4, 5}) EXPECT_EQ(grown.keyframes[id].world, 0) << id;
  EXPECT_EQ(grown.keyframes[6].world, 2);
  EXPECT_EQ(grown.keyframes[6].world_T_camera.translation, poseOf(6).translation);
  EXPECT_EQ(grown.keyframes[1].world_T_camera.translation, copy.keyframes[1].world_T_camera.translation);
  const Eigen::Vector3d should_be = join.to_S_from * poseOf(5).translation;
  EXPECT_LT((grown.keyframes[5].world_T_camera.translation - should_be).norm(), 1e-9);
}

}  // namespace
}  // namespace edgeslam::test
