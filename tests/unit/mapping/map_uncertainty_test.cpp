// How far the map may have drifted grows along the way and shrinks at old points.
#include "mapping/map_uncertainty.h"

#include <gtest/gtest.h>

#include <utility>

#include "mapping/local_adjustment.h"
#include "unit/mapping/edge_scene.h"
#include "unit/mapping/landmark_walk.h"

namespace edgeslam {
namespace {

double positionSigma(const Keyframe& keyframe) { return std::sqrt(keyframe.uncertainty.topLeftCorner<3, 3>().trace()); }

// Once round and past the beginning. Points seen in the first lap are other ones than in the second.
struct Lap {
  test::Walk walk{5, 400};

  Lap() {
    for (int i = 0; i < 30; ++i) walk.step();
    for (auto& [id, point] : walk.map.points) point.inverse_depth_sigma = 0.02 * point.inverse_depth;
  }
};

TEST(MapUncertainty, GrowsAlongTheWay) {
  Lap lap;
  Map& map = lap.walk.map;
  renewUncertainty(test::Walk::camera(), {}, map);
  EXPECT_EQ(map.keyframes.front().uncertainty.norm(), 0);
  EXPECT_GT(positionSigma(map.keyframes[1]), 0);
  for (const KeyframeId id : {10, 20, 29}) {
    EXPECT_GT(positionSigma(map.keyframes[id]), 1.2 * positionSigma(map.keyframes[id - 9])) << id;
    EXPECT_GT(map.keyframes[id].uncertainty(6, 6), map.keyframes[id - 9].uncertainty(6, 6)) << id;
    EXPECT_LT(positionSigma(map.keyframes[id]), 1) << "it is known";
  }
}

TEST(MapUncertainty, AddedOneByOneIsAsGoodAsAnewWhereThereIsNoLoop) {
  test::Walk walk(6, 400);
  for (int i = 0; i < 20; ++i) {
    walk.step();
    for (auto& [id, point] : walk.map.points) point.inverse_depth_sigma = 0.02 * point.inverse_depth;
    addUncertainty(test::Walk::camera(), {}, walk.map);
  }
  Map anew = walk.map;
  renewUncertainty(test::Walk::camera(), {}, anew);
  for (const Keyframe& keyframe : anew.keyframes) {
    if (keyframe.id < 2) continue;
    const double ratio = positionSigma(walk.map.keyframes[keyframe.id]) / positionSigma(keyframe);
    EXPECT_GT(ratio, 0.7) << keyframe.id;
    EXPECT_LT(ratio, 2) << keyframe.id;
  }
}

TEST(MapUncertainty, EndsWhereOldPointsAreSeenAgain) {
  test::Walk walk(7, 400);
  for (int i = 0; i < test::Walk::steps_a_lap; ++i) walk.step();
  for (auto& [id, point] : walk.map.points) point.inverse_depth_sigma = 0.02 * point.inverse_depth;
  renewUncertainty(test::Walk::camera(), {}, walk.map);
  const KeyframeId opposite = test::Walk::steps_a_lap / 2, last = test::Walk::steps_a_lap - 1;
  EXPECT_GT(positionSigma(walk.map.keyframes[opposite]), 2 * positionSigma(walk.map.keyframes[last]));
}

// What nothing ties to the rest is not given out as known.
TEST(MapUncertainty, OfAKeyframeThatSharesNothingIsLarge) {
  Lap lap;
  Map& map = lap.walk.map;
  Keyframe alone;
  alone.id = 30;
  alone.world_T_camera.translation = {3, 0, 0};
  map.keyframes.push_back(alone);
  renewUncertainty(test::Walk::camera(), {}, map);
  EXPECT_GE(positionSigma(map.keyframes.back()), 1);
  map.keyframes.back().uncertainty.setZero();
  addUncertainty(test::Walk::camera(), {}, map);
  EXPECT_GE(positionSigma(map.keyframes.back()), 1);
  EXPECT_LT(positionSigma(map.keyframes[29]), 1);
}

// All of its points err together, and slide along it.
TEST(MapUncertainty, PointsOfOneStraightEdgeTellWhatAFewTell) {
  Lap lap;
  Map& map = lap.walk.map;
  renewUncertainty(test::Walk::camera(), {}, map);
  const Keyframe free = map.keyframes[1];
  for (Keyframe& keyframe : map.keyframes) {
    keyframe.straight_edges.resize(1);
    std::vector<PointObservation> on_edge(keyframe.observations.begin(), keyframe.observations.end());
    for (PointObservation& seen : on_edge) seen.straight_edge = 0;
    keyframe.observations = SharedList<PointObservation>(std::move(on_edge));
  }
  MapUncertaintyOptions options;
  options.independent_on_edge = 1e9;
  renewUncertainty(test::Walk::camera(), options, map);
  const Keyframe sliding = map.keyframes[1];
  EXPECT_GT(positionSigma(sliding), positionSigma(free));
  EXPECT_EQ(sliding.uncertainty(6, 6), free.uncertainty(6, 6));
  renewUncertainty(test::Walk::camera(), {}, map);
  EXPECT_GT(positionSigma(map.keyframes[1]), positionSigma(sliding));
  EXPECT_GT(map.keyframes[1].uncertainty(6, 6), free.uncertainty(6, 6));
}

// Simulated measurements with the noise that they state, in many maps: the error of the last keyframe is one that its
// uncertainty foretells. What its links leave out (the noise of the points' own bearings, that depths and poses go
// together) makes the squared error seven times what they say alone; the options' factors make up for it.
TEST(MapUncertainty, ForetellsTheErrorOfAnAdjustedMap) {
  const Camera camera = test::testCamera(CameraModel::pinhole_radial_tangential);
  const test::EdgeScene scene = test::framesOnAWall(8);
  std::vector<Pose> truth;
  for (int i = 0; i < 6; ++i) truth.push_back({rotationExp({0.01 * i, -0.02 * i, 0}), {0.12 * i, 0.03 * (i % 2), 0}});
  test::Sight sight;
  sight.noise = 1;
  MapUncertaintyOptions options;
  options.position_walk = options.rotation_walk = options.scale_walk = 0;
  double sum = 0;
  constexpr int maps = 60;
  for (int trial = 0; trial < maps; ++trial) {
    test::Random random(static_cast<std::uint64_t>(100 + trial));
    Map map = test::keyframesOf(camera, scene, truth, sight, random);
    test::addAllPoints(scene, map);
    LocalAdjustmentOptions all;
    all.free_keyframes = 4;
    ASSERT_TRUE(adjustKeyframes(camera, all, {2, 3, 4, 5}, {0, 1}, map));
    renewUncertainty(camera, options, map);
    const Keyframe& last = map.keyframes.back();
    const Eigen::Vector3d error =
        last.world_T_camera.rotation.conjugate() * (truth.back().translation - last.world_T_camera.translation);
    sum += error.dot(last.uncertainty.topLeftCorner<3, 3>().inverse() * error) / 3;
  }
  EXPECT_GT(sum / maps, 0.1);
  EXPECT_LT(sum / maps, 1);
}

}  // namespace
}  // namespace edgeslam
