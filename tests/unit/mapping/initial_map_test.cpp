// P14: the map of an accepted initial structure has its keyframes, and the points that are known and seen.
#include "mapping/initial_map.h"

#include <gtest/gtest.h>

#include "unit/mapping/frames_of_a_scene.h"

namespace edgeslam {
namespace {

const test::EdgeScene mapped_wall = test::framesOnAWall(5);

std::vector<Pose> straightPath() { return test::row(7, 0.05); }

InitialStructure structureOf(const InitialFrames& frames) {
  return test::trueStructure(mapped_wall, frames, {2, 5}, {straightPath()[3], straightPath()[6]});
}

TEST(InitialMap, HasTheStructuresFramesAndItsKnownPoints) {
  InitialFrames frames = test::initialFrames(test::distorted_camera, mapped_wall, straightPath());
  InitialStructure structure = structureOf(frames);
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
  EXPECT_EQ(map.keyframes[2].world_T_camera.translation, straightPath()[6].translation);
  EXPECT_EQ(map.points.count(uncertain), 0U);
  EXPECT_EQ(map.points.count(unseen), 0U);
  EXPECT_GT(map.points.size(), frames.first.observations.size() / 2);
  for (const auto& [id, point] : map.points) EXPECT_FALSE(point.seen_in.empty()) << id;
}

TEST(InitialMap, FramesThatItWasNotMadeOfAreLocatedToo) {
  const InitialFrames frames = test::initialFrames(test::distorted_camera, mapped_wall, straightPath());
  const auto poses = posesOfInitialFrames(test::distorted_camera, frames, structureOf(frames));
  ASSERT_EQ(poses.size(), 7U);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    EXPECT_EQ(poses[k].first, static_cast<std::int64_t>(k));
    EXPECT_LT(test::distance(poses[k].second, straightPath()[k]), 1e-6);
  }
}

TEST(InitialMap, PosesEndWhereAFrameCannotBeLocated) {
  InitialFrames frames = test::initialFrames(test::distorted_camera, mapped_wall, straightPath());
  frames.since[2].observations.clear();
  const auto poses = posesOfInitialFrames(test::distorted_camera, frames, structureOf(frames));
  ASSERT_EQ(poses.size(), 4U);
  EXPECT_EQ(poses[0].first, 0);
  EXPECT_EQ(poses[1].first, 4);
}

}  // namespace
}  // namespace edgeslam
