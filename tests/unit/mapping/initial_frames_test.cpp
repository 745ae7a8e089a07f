// P13: which frames a map may be started from.
#include "mapping/initial_frames.h"

#include <gtest/gtest.h>

#include "unit/mapping/frames_of_a_scene.h"

namespace edgeslam {
namespace {

InitialFrames framesSince(int count) {
  InitialFrames frames;
  for (int i = 0; i < count; ++i) {
    TrackedFrame frame;
    frame.frame_index = i + 1;
    addFrame(frames, frame);
  }
  return frames;
}

TEST(InitialFrames, ThoseThatAreSpreadEndWithTheCurrentOne) {
  EXPECT_EQ(spreadFrames(framesSince(27), 9), (std::vector<std::size_t>{2, 5, 8, 11, 14, 17, 20, 23, 26}));
  EXPECT_EQ(spreadFrames(framesSince(3), 9), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(spreadFrames(framesSince(1), 9), (std::vector<std::size_t>{0}));
}

TEST(InitialFrames, OfVeryManyEverySecondIsKeptAndTheCurrentOneIsAmongThem) {
  const InitialFrames frames = framesSince(402);
  EXPECT_LT(frames.since.size(), 210U);
  EXPECT_EQ(frames.current().frame_index, 402);
  EXPECT_EQ(frames.since[1].frame_index - frames.since[0].frame_index, 2);
}

TEST(InitialFrames, BearingsAreOfThePointsThatBothSee) {
  const Camera camera = test::testCamera(CameraModel::pinhole_radial_tangential);
  const test::EdgeScene scene = test::framesOnAWall(1);
  TrackedFrame first = test::seen(camera, scene, Pose(), 0, 0), other = test::seen(camera, scene, test::at(0.1), 1, -1);
  first.observations.resize(20);
  other.observations.erase(other.observations.begin(), other.observations.begin() + 10);
  const CommonBearings bearings = commonBearings(first, other);
  ASSERT_EQ(bearings.in_first.size(), bearings.in_other.size());
  ASSERT_FALSE(bearings.in_first.empty());
  EXPECT_LE(bearings.in_first.size(), 10U);
  EXPECT_EQ(bearings.in_first.back(), first.observations.back().bearing);
  EXPECT_EQ(bearings.in_other.front(), other.observations.front().bearing);
}

}  // namespace
}  // namespace edgeslam
