#include "service/world_watch.h"

#include <gtest/gtest.h>

#include "unit/lcm/made_frames.h"

namespace edgeslam {
namespace {

FrameResult frameIn(int world, TrackingState state = TrackingState::tracking) {
  FrameResult frame = measuredFrame(0, Pose());
  frame.world = world;
  frame.state = state;
  return frame;
}

TEST(WorldWatch, ANewMapIsToldWithWhyTheCameraWasLost) {
  WorldWatch watch;
  EXPECT_EQ(watch.world(), -1);
  EXPECT_EQ(watch.frame(frameIn(0)), std::nullopt) << "the first map begins beside none";
  EXPECT_EQ(watch.frame(frameIn(0)), std::nullopt);
  EXPECT_EQ(watch.frame(frameWithoutPose(1, TrackingState::lost, "map points not found again")), std::nullopt);
  EXPECT_EQ(watch.world(), 0);
  EXPECT_EQ(watch.frame(frameIn(1)), "map 1 is begun beside map 0: lost there, map points not found again");
  EXPECT_EQ(watch.world(), 1);
  EXPECT_EQ(watch.count(), 2);
  EXPECT_EQ(watch.frame(frameIn(2)), "map 2 is begun beside map 1");
}

TEST(WorldWatch, AJoinAndAReturnAreToldApart) {
  WorldWatch watch;
  watch.frame(frameIn(0));
  watch.frame(frameIn(1));
  EXPECT_EQ(watch.frame(frameIn(0, TrackingState::relocalised)), "back in map 0 from map 1: found again there");
  EXPECT_EQ(watch.count(), 2);
  watch.frame(frameIn(1, TrackingState::relocalised));
  EXPECT_EQ(watch.frame(frameIn(0)), "map 1 is joined to map 0: they are of the same place");
  EXPECT_EQ(watch.count(), 1);
}

TEST(WorldWatch, GuessedPosesAndAnotherRunTellNothing) {
  WorldWatch watch;
  watch.frame(frameIn(0));
  EXPECT_EQ(watch.frame(frameIn(1, TrackingState::predicted)), std::nullopt);
  EXPECT_EQ(watch.world(), 0);
  watch.begin();
  EXPECT_EQ(watch.count(), 0);
  EXPECT_EQ(watch.frame(frameIn(3)), std::nullopt);
}

}  // namespace
}  // namespace edgeslam
