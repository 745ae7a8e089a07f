// P7, P17: tracks become map points where their views agree on a depth.
#include "mapping/new_points.h"

#include <gtest/gtest.h>

#include "unit/map/change_each.h"
#include "unit/mapping/edge_scene.h"

namespace edgeslam {
namespace {

using test::EdgeScene;
using test::Sight;

Pose movedSideways(double x) { return {Eigen::Quaterniond::Identity(), {x, 0, 0}}; }

// Adds keyframe by keyframe, as mapping does; returns how many points became map points at the last one.
int mapAll(const Map& keyframes, const NewPointOptions& options, Map& map, Candidates& candidates) {
  int added = 0;
  for (const Keyframe& keyframe : keyframes.keyframes) {
    map.keyframes.push_back(keyframe);
    associate(map, candidates);
    added = addNewPoints(test::distorted_camera, options, map, candidates);
  }
  return added;
}

// One point, seen from two places.
struct OnePoint {
  EdgeScene scene;
  Map map;
  Candidates candidates;

  int add(
      const std::vector<Pose>& poses, const NewPointOptions& options, const Sight& sight = Sight(),
      const std::function<void(Map&)>& spoil = [](Map&) {}) {
    test::Random random(1);
    Map keyframes = test::keyframesOf(test::distorted_camera, scene, poses, sight, random);
    spoil(keyframes);
    return mapAll(keyframes, options, map, candidates);
  }
};

// An edge in the direction given, at 2 in front of the first camera.
OnePoint pointOf(const Eigen::Vector3d& direction, bool corner = false) {
  OnePoint one;
  one.scene.points.push_back({Eigen::Vector3d(0.2, -0.1, 2), direction.normalized(), 4, 7, corner});
  return one;
}

const Eigen::Vector3d upright(0, 1, 0);

TEST(NewPoints, PointsOfKnownStructureGetTheirDepths) {
  const EdgeScene scene = test::framesOnAWall(5);
  test::Random random(6);
  const Map keyframes = test::keyframesOf(test::distorted_camera, scene,
                                          {movedSideways(0), movedSideways(0.25), movedSideways(0.5)}, Sight(), random);
  Map map;
  Candidates candidates;
  mapAll(keyframes, NewPointOptions(), map, candidates);
  EXPECT_GT(map.points.size(), 200U);
  for (const auto& [id, point] : map.points) {
    EXPECT_LT((worldPosition(map, point) - scene.points[static_cast<std::size_t>(id)].position).norm(), 1e-6);
    EXPECT_EQ(point.host, 0);
    EXPECT_EQ(point.chain, scene.points[static_cast<std::size_t>(id)].chain);
    EXPECT_EQ(point.order, scene.points[static_cast<std::size_t>(id)].order);
    EXPECT_EQ(candidates.count(id), 0U) << "is no candidate any more";
  }
}

TEST(NewPoints, AssociateAddsViewsToPointsAndTheRestToTheCandidates) {
  OnePoint one = pointOf(upright);
  one.scene.points.push_back(
      {Eigen::Vector3d(-0.3, 0.1, 2), Eigen::Vector3d::UnitX(), 5, 0, false});  // never gets depth
  one.add({movedSideways(0), movedSideways(0.2), movedSideways(0.4)}, NewPointOptions());
  ASSERT_EQ(one.map.points.size(), 1U);
  EXPECT_EQ(one.map.points.at(0).seen_in, (std::vector<KeyframeId>{1, 2}));
  ASSERT_EQ(one.candidates.size(), 1U);
  EXPECT_EQ(one.candidates.at(1), (std::vector<KeyframeId>{0, 1, 2}));
}

TEST(NewPoints, AnEdgeAlongTheMotionGetsNoDepth) {
  EXPECT_EQ(pointOf(upright).add({movedSideways(0), movedSideways(0.3)}, NewPointOptions()), 1);
  EXPECT_EQ(pointOf({1, 1, 0}).add({movedSideways(0), movedSideways(0.3)}, NewPointOptions()), 1);
  EXPECT_EQ(pointOf({1, 0, 0}).add({movedSideways(0), movedSideways(0.3)}, NewPointOptions()), 0);
  EXPECT_EQ(pointOf({1, 0, 0}, true).add({movedSideways(0), movedSideways(0.3)}, NewPointOptions()), 1) << "a corner";
}

TEST(NewPoints, TooLittleParallaxGivesNoDepth) {
  NewPointOptions options;
  options.largest_depth_sigma = 1e9;
  options.least_parallax_deg = 1.0;
  const double one_degree = 2 * std::tan(M_PI / 180);
  EXPECT_EQ(pointOf(upright).add({movedSideways(0), movedSideways(0.9 * one_degree)}, options), 0);
  EXPECT_EQ(pointOf(upright).add({movedSideways(0), movedSideways(1.1 * one_degree)}, options), 1);
}

TEST(NewPoints, AnUncertainDepthIsNone) {
  // Half a pixel of 410 over a baseline b at distance 2: sigma / inverse depth = 0.5 / 410 * 2 / b, about.
  NewPointOptions options;
  options.least_parallax_deg = 0;
  EXPECT_EQ(pointOf(upright).add({movedSideways(0), movedSideways(0.012)}, options), 0);
  EXPECT_EQ(pointOf(upright).add({movedSideways(0), movedSideways(0.022)}, options), 1);
}

TEST(NewPoints, ThePointStaysACandidateUntilItsDepthIsKnown) {
  OnePoint one = pointOf(upright);
  EXPECT_EQ(
      one.add({movedSideways(0), movedSideways(0.005), movedSideways(0.01), movedSideways(0.2)}, NewPointOptions()), 1);
  EXPECT_EQ(one.map.points.at(0).host, 0);
  EXPECT_EQ(one.map.points.at(0).seen_in, (std::vector<KeyframeId>{1, 2, 3}));
}

TEST(NewPoints, ViewsThatContradictEachOtherGiveNoDepth) {
  NewPointOptions options;
  options.fewest_views = 3;
  const std::vector<Pose> poses{movedSideways(0), movedSideways(0.15), movedSideways(0.3)};
  EXPECT_EQ(pointOf(upright).add(poses, options), 1);
  const auto spoil = [](Map& map) {
    test::changeEach(map.keyframes[1].observations, [](PointObservation& seen) {
      seen.measurement.pixel.x() += 6;  // twelve of its standard deviations
      seen.bearing = bearing(test::distorted_camera, seen.measurement.pixel);
    });
  };
  EXPECT_EQ(pointOf(upright).add(poses, options, Sight(), spoil), 0);
}

// Thirty points at 2, and one that moves against the camera: it seems to be forty times nearer.
TEST(NewPoints, WhatSeemsFarNearerThanTheSceneIsNoPoint) {
  EdgeScene scene;
  for (int i = 0; i < 30; ++i) scene.points.push_back({Eigen::Vector3d(0.05 * i - 0.7, 0.1, 2), upright, i, 0, false});
  scene.points.push_back({Eigen::Vector3d(0.02, 0, 0.05), upright, 30, 0, false});
  test::Random random(1);
  Sight sight;
  sight.least_depth = 0.01;
  Map keyframes = test::keyframesOf(test::distorted_camera, scene,
                                    {movedSideways(-0.3), movedSideways(0), movedSideways(0.01)}, sight, random);
  ASSERT_EQ(findObservation(keyframes.keyframes[0], 30), nullptr) << "it comes once the scene is known";
  NewPointOptions options;
  for (const double least : {0.0, 0.05}) {
    options.least_distance = least;
    Map map;
    Candidates candidates;
    mapAll(keyframes, options, map, candidates);
    EXPECT_EQ(map.points.size(), least == 0 ? 31U : 30U);
    EXPECT_EQ(map.points.count(30), least == 0 ? 1U : 0U);
  }
}

// P7: a corner off its epipolar lines, which two of the views' depth would hide.
TEST(NewPoints, ACornerOffTheCrossingOfItsEpipolarLinesIsRefused) {
  NewPointOptions options;
  options.fewest_views = 3;
  options.largest_error = 1e9;
  const std::vector<Pose> poses{movedSideways(0), {Eigen::Quaterniond::Identity(), {0.15, 0.1, 0}}, movedSideways(0.3)};
  EXPECT_EQ(pointOf(upright, true).add(poses, options), 1);
  const auto spoil = [](Map& map) {
    test::changeEach(map.keyframes[1].observations, [](PointObservation& seen) {
      seen.measurement.pixel += Eigen::Vector2d(2, 2);
      seen.bearing = bearing(test::distorted_camera, seen.measurement.pixel);
    });
  };
  EXPECT_EQ(pointOf(upright, true).add(poses, options, Sight(), spoil), 0);
  EXPECT_EQ(pointOf(upright, false).add(poses, options, Sight(), spoil), 1) << "an edge point may have slid";
}

TEST(NewPoints, APointBehindTheCamerasIsRefused) {
  const auto swap = [](Map& map) {  // parallax of the wrong sign
    std::swap(map.keyframes[0].world_T_camera, map.keyframes[1].world_T_camera);
  };
  EXPECT_EQ(pointOf(upright).add({movedSideways(0), movedSideways(0.3)}, NewPointOptions(), Sight(), swap), 0);
}

TEST(NewPoints, WhatIsNoLongerFollowedIsForgotten) {
  OnePoint one = pointOf(upright);
  const auto unseen = [](Map& map) { map.keyframes[2].observations.clear(); };
  one.add({movedSideways(0), movedSideways(0.001), movedSideways(0.3)}, NewPointOptions(), Sight(), unseen);
  EXPECT_TRUE(one.map.points.empty());
  EXPECT_TRUE(one.candidates.empty());
}

TEST(NewPoints, TheSigmaThatIsKeptIsHonest) {
  // Over many noisy pairs the errors of the inverse depth are as large as their standard deviations say.
  double sum = 0;
  int count = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    OnePoint one = pointOf(upright);
    test::Random random(seed);
    Sight sight;
    sight.noise = 1;
    Map keyframes =
        test::keyframesOf(test::distorted_camera, one.scene, {movedSideways(0), movedSideways(0.3)}, sight, random);
    // The host bearing counts as exact.
    test::changeEach(keyframes.keyframes[0].observations, [&](PointObservation& host) {
      host.measurement.pixel = project(test::distorted_camera, one.scene.points[0].position);
      host.bearing = one.scene.points[0].position.normalized();
    });
    if (mapAll(keyframes, NewPointOptions(), one.map, one.candidates) == 0) continue;
    const MapPoint& point = one.map.points.at(0);
    const double error = point.inverse_depth - 1 / one.scene.points[0].position.norm();
    sum += error * error / (point.inverse_depth_sigma * point.inverse_depth_sigma);
    ++count;
  }
  EXPECT_GT(count, 190);
  EXPECT_NEAR(sum / count, 1, 0.35);
}

}  // namespace
}  // namespace edgeslam
