// The frame before becomes a keyframe once this one is located: what changed in it is followed on.
#include "tracking/frame_location.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "edges/point_choice.h"
#include "unit/tracking/plane_walk.h"

namespace edgeslam {
namespace {

FollowedFrame frameAt(int i) {
  FollowedFrame frame;
  frame.images = imagesOf(imageAt(i), i);
  frame.edges = std::make_shared<EdgeMap>(detectEdges(imageAt(i), EdgeOptions()));
  frame.world_T_camera = walk(i);
  frame.scene_depth = wall().distance;
  return frame;
}

std::vector<Track> chosenIn(const FollowedFrame& frame) {
  std::vector<Track> tracks;
  for (const ChosenPoint& chosen : choosePoints(imageAt(0), *frame.edges, {}, PointChoiceOptions())) {
    tracks.push_back(trackAt(static_cast<PointId>(tracks.size()), chosen.pixel, chosen.normal));
    tracks.back().corner = chosen.corner;
  }
  return tracks;
}

// Where a pixel of frame `from` is seen in frame `to`.
Eigen::Vector2f seenFrom(int from, int to, const Eigen::Vector2f& pixel) {
  const Eigen::Vector3d place = wall().seenAt(walking_camera, walk(from), pixel.cast<double>());
  return project(walking_camera, walk(to).inverse() * place).cast<float>();
}

const Track* find(const std::vector<Track>& tracks, PointId id) {
  const auto found = std::find_if(tracks.begin(), tracks.end(), [&](const Track& track) { return track.id == id; });
  return found == tracks.end() ? nullptr : &*found;
}

// Of the tracks of frame 0 every third one was followed into frame 1, to a pixel that tells it from others; every third
// was as well, and moved in frame 0 since; and every third is new.
struct LateKeyframe {
  FollowedFrame last = frameAt(0), frame = frameAt(1);
  std::vector<PlacedTrack> before;
  const Eigen::Vector2f mark{0.25F, 0.125F};

  LateKeyframe() {
    last.tracks = chosenIn(last);
    for (Track& track : last.tracks) {
      track.keyframe = 7;
      track.keyframe_images = last.images;
      const bool is_new = track.id % 3 == 2;
      if (is_new) continue;
      const Eigen::Vector2f moved = track.id % 3 == 1 ? Eigen::Vector2f(2, 1) : Eigen::Vector2f(0, 0);
      before.push_back({track.id, track.pixel - moved});
      Track followed = track;
      followed.keyframe = 3;
      followed.keyframe_images.reset();
      followed.pixel = seenFrom(0, 1, track.pixel - moved) + mark;
      frame.tracks.push_back(followed);
    }
    MapView view;
    view.initialised = true;
    std::vector<Track> changed;
    FrameLocation(walking_camera, LocationOptions())
        .followChanged(last, before, view, PointAccuracy(), frame, changed, *std::pmr::get_default_resource());
  }
};

TEST(FrameLocation, WhatIsNewOrMovedInALateKeyframeIsFollowedOn) {
  const LateKeyframe made;
  ASSERT_GT(made.last.tracks.size(), 100U);
  std::size_t changed = 0, found = 0;
  for (const Track& track : made.last.tracks) {
    if (track.id % 3 == 0) continue;
    ++changed;
    const Track* followed = find(made.frame.tracks, track.id);
    if (!followed) continue;
    ++found;
    const Eigen::Vector2f error = followed->pixel - seenFrom(0, 1, track.pixel);
    EXPECT_LT(std::abs(track.normal.dot(error)), 0.5F) << track.id;
  }
  EXPECT_GT(found, changed * 2 / 3);
}

TEST(FrameLocation, WhatStayedIsNotFollowedAgainAndGoesOnFromTheKeyframe) {
  const LateKeyframe made;
  std::size_t stayed = 0;
  for (const Track& track : made.last.tracks) {
    if (track.id % 3 != 0) continue;
    const Track* followed = find(made.frame.tracks, track.id);
    ASSERT_TRUE(followed) << track.id;
    EXPECT_EQ(followed->pixel, Eigen::Vector2f(seenFrom(0, 1, track.pixel) + made.mark)) << track.id;
    EXPECT_EQ(followed->keyframe_pixel, track.pixel);
    ++stayed;
  }
  EXPECT_GT(stayed, 30U);
  for (const Track& track : made.frame.tracks) {
    EXPECT_EQ(track.keyframe, 7) << track.id;
    EXPECT_EQ(track.keyframe_images, made.last.images) << track.id;
  }
  EXPECT_TRUE(std::is_sorted(made.frame.tracks.begin(), made.frame.tracks.end(),
                             [](const Track& a, const Track& b) { return a.id < b.id; }));
}

}  // namespace
}  // namespace edgeslam
