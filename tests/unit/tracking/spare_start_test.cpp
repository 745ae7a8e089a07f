// A younger first frame beside that of a start.
#include "tracking/spare_start.h"

#include <gtest/gtest.h>

#include "unit/tracking/textured_plane.h"

namespace edgeslam {
namespace {

// Tracks 0 to `count` - 1 of a frame, each at a pixel of its own.
FollowedFrame frameWith(int count, const Pose& world_T_camera, std::int64_t index, float shift = 0) {
  FollowedFrame frame;
  frame.images = imagesOf(cv::Mat(240, 320, CV_8U, cv::Scalar(90)), index);
  for (int i = 0; i < count; ++i) {
    frame.tracks.push_back(trackAt(i, {20 + 2 * static_cast<float>(i) + shift, 50 + shift}));
  }
  frame.world_T_camera = world_T_camera;
  return frame;
}

const Pose at_spare{rotationExp({0, 0.1, 0}), {0.2, 0, 0.1}};

TEST(SpareStart, KnowsWhichTracksAreOlder) {
  SpareStart spare(200);
  FollowedFrame frame = frameWith(60, at_spare, 7);
  EXPECT_FALSE(spare.isThere());
  EXPECT_EQ(spare.countOlder(frame.tracks), 60U) << "without one, all of them";
  spare.begin(smallCamera(), frame, 4, /*first_new_point=*/40);
  ASSERT_TRUE(spare.isThere());
  EXPECT_EQ(spare.countOlder(frame.tracks), 40U);
  frame.tracks.erase(frame.tracks.begin(), frame.tracks.begin() + 15);
  EXPECT_EQ(spare.countOlder(frame.tracks), 25U);
  spare.forget();
  EXPECT_FALSE(spare.isThere());
}

TEST(SpareStart, AFrameThatItAdoptsIsAgainstItsOwn) {
  SpareStart spare(200);
  const FollowedFrame first = frameWith(60, at_spare, 7);
  spare.begin(smallCamera(), first, 4, 40);
  const Pose since{rotationExp({0.02, 0, 0}), {0.05, 0.01, 0}};
  FollowedFrame later = frameWith(60, at_spare * since, 9, 3);
  later.tracks.erase(later.tracks.begin() + 10, later.tracks.begin() + 30);
  spare.adopt(later);
  EXPECT_LT((later.world_T_camera.translation - since.translation).norm(), 1e-12);
  EXPECT_LT(rotationAngle(later.world_T_camera.rotation, since.rotation), 1e-7);
  for (const Track& track : later.tracks) {
    EXPECT_EQ(track.keyframe, 4);
    EXPECT_EQ(track.keyframe_images, first.images);
    EXPECT_EQ(track.keyframe_pixel, first.tracks[static_cast<std::size_t>(track.id)].pixel);
    EXPECT_EQ(track.last_keyframe_pixel, track.keyframe_pixel);
  }
}

}  // namespace
}  // namespace edgeslam
