// P14: the map of an accepted initial structure has its keyframes, and the points that are known and seen.
#include "mapping/initial_map.h"

#include <gtest/gtest.h>

#include "unit/mapping/frames_of_a_scene.h"

namespace edgeslam {
namespace {

const Camera camera = test::testCamera(CameraModel::pinhole_radial_tangential);
const test::EdgeScene scene = test::framesOnAWall(5);

std::vector<Pose> path() { return test::row(7, 0.05); }

InitialStructure truth(const InitialFrames& frames) {
  InitialStructure structure;
  structure.frames = {2, 5};
  structure.first_T_camera = {path()[3], path()[6]};
  for (const PointObservation& observation : frames.first.observations) {
    structure.inverse_depths.push_back(1 / scene.points[static_cast<std::size_t>(observation.point)].position.norm());
    structure.depth_sigmas.push_back(0.05 * structure.inverse_depths.back());
  }
  return structure;
}

TEST(InitialMap, HasTheStructuresFramesAndItsKnownPoints) {
  InitialFrames frames = test::initialFrames(camera, scene, path());
  InitialStructure structure = truth(frames);
  const PointId uncertain = frames.first.observations[0].point, unseen = frames.first.observations[1].point;
  structure.depth_sigmas[0] = structure.inverse_depths[0];
  for (TrackedFrame& frame : frames.since) {
    const auto end = std::remove_if(frame.observations.begin(), frame.observations.end(),
                                    [&](const PointObservation& o) { return o.point == unseen; });
    frame.observations.erase(end, frame.observations.end());
  }
  const Map map = initialMap({}, frames, structure, 0.15);
  ASSERT_EQ(map.keyframes.size(), 3U);
  EXPECT_EQ(map.keyframes[0].reason, "first");
  EXPECT_EQ(map.keyframes[2].reason, "initialisation");
  EXPECT_EQ(map.keyframes[2].frame_index, 6);
  EXPECT_EQ(map.keyframes[2].world_T_camera.translation, path()[6].translation);
  EXPECT_EQ(map.points.count(uncertain), 0U);
  EXPECT_EQ(map.points.count(unseen), 0U);
  EXPECT_GT(map.points.size(), frames.first.observations.size() / 2);
  for (const auto& [id, point] : map.points) EXPECT_FALSE(point.seen_in.empty()) << id;
}

TEST(InitialMap, FramesThatItWasNotMadeOfAreLocatedToo) {
  const InitialFrames frames = test::initialFrames(camera, scene, path());
  const auto poses = posesOfInitialFrames(camera, frames, truth(frames));
  ASSERT_EQ(poses.size(), 7U);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    EXPECT_EQ(poses[k].first, static_cast<std::int64_t>(k));
    EXPECT_LT(test::distance(poses[k].second, path()[k]), 1e-6);
  }
}

TEST(InitialMap, PosesEndWhereAFrameCannotBeLocated) {
  InitialFrames frames = test::initialFrames(camera, scene, path());
  frames.since[2].observations.clear();
  const auto poses = posesOfInitialFrames(camera, frames, truth(frames));
  ASSERT_EQ(poses.size(), 4U);
  EXPECT_EQ(poses[0].first, 0);
  EXPECT_EQ(poses[1].first, 4);
}

}  // namespace
}  // namespace edgeslam
