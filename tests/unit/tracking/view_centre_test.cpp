#include "tracking/view_centre.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/angles.h"

namespace edgeslam {
namespace {

// Numbered 0, 2, 4 ..., one map unit apart along x, all looking along z.
MapView rowOfKeyframes(int count) {
  MapView view;
  for (int i = 0; i < count; ++i) {
    ViewKeyframe keyframe;
    keyframe.id = 2 * i;
    keyframe.world_T_camera.translation.x() = i;
    view.keyframes.push_back(keyframe);
  }
  return view;
}

Pose poseAt(double x, double turn_deg = 0) { return {rotationExp({0, radians(turn_deg), 0}), {x, 0, 0}}; }

TEST(NearestKeyframe, IsTheNearestFromAnyOtherOnceTheCameraIsThere) {
  const MapView view = rowOfKeyframes(10);
  for (KeyframeId current = 0; current < 20; current += 2) {
    for (int i = 0; i < 10; ++i) EXPECT_EQ(nearestKeyframe(view, poseAt(i), 5, current), 2 * i);
  }
}

TEST(NearestKeyframe, StaysWhereTwoAreAboutAsNear) {
  const MapView view = rowOfKeyframes(10);
  EXPECT_EQ(nearestKeyframe(view, poseAt(4.5), 5, 8), 8);
  EXPECT_EQ(nearestKeyframe(view, poseAt(4.5), 5, 10), 10);
  EXPECT_EQ(nearestKeyframe(view, poseAt(4.55), 5, 8), 8);
  EXPECT_EQ(nearestKeyframe(view, poseAt(4.8), 5, 8), 10);
}

TEST(NearestKeyframe, LooksTheSameWay) {
  MapView view = rowOfKeyframes(2);
  ViewKeyframe turned;
  turned.id = 7;
  turned.world_T_camera = poseAt(0.5, 90);
  view.keyframes.push_back(turned);
  EXPECT_EQ(nearestKeyframe(view, poseAt(0, 80), 5, 0), 7);
  EXPECT_EQ(nearestKeyframe(view, poseAt(0.5, 10), 5, 2), 2);
}

TEST(NearestKeyframe, OneThatIsNotInTheViewIsLeft) {
  EXPECT_EQ(nearestKeyframe(rowOfKeyframes(5), poseAt(3), 5, -1), 6);
  EXPECT_EQ(nearestKeyframe(rowOfKeyframes(5), poseAt(3), 5, 99), 6);
  EXPECT_EQ(nearestKeyframe(MapView(), poseAt(3), 5, 4), 4) << "there is none";
}

}  // namespace
}  // namespace edgeslam
