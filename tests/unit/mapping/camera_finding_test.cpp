#include "mapping/camera_finding.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mapping/readout_estimate.h"
#include "unit/mapping/wrong_lens.h"

namespace edgeslam {
namespace {

constexpr double largest_motion = 0.5, noise_px = 0.2;
constexpr double longest_s = 0.05;

// Looks at the map as often as it takes.
FoundCamera foundIn(test::Walk& walk, CameraFinding& finding) {
  for (int keyframe = 0; keyframe < 400 && !finding.isSettled(); ++keyframe) {
    finding.look(test::Walk::camera(), {}, {}, walk.map);
  }
  return walk.map.found;
}

TEST(CameraFinding, ARollingShutterIsFoundAndTheMapAdjustedToIt) {
  test::Walk walk = test::rollingWalk(4, 20, 0.02, largest_motion, noise_px);
  CameraFinding finding({});
  const FoundCamera found = foundIn(walk, finding);
  ASSERT_TRUE(found.readout_s);
  EXPECT_NEAR(*found.readout_s, 0.02, 0.0015);
  EXPECT_EQ(found.focal_scale, 1);
  EXPECT_TRUE(finding.isSettled());
  double cost_found = 0, cost_global = 0;
  test::Walk as_global = test::rollingWalk(4, 20, 0.02, largest_motion, noise_px);
  const std::vector<KeyframeId> all = test::allKeyframes(walk.map);
  ASSERT_TRUE(adjustKeyframes(withFound(test::Walk::camera(), found), {}, all, {}, walk.map, nullptr, &cost_found));
  ASSERT_TRUE(adjustKeyframes(test::Walk::camera(), {}, all, {}, as_global.map, nullptr, &cost_global));
  EXPECT_LT(cost_found, 0.5 * cost_global);
}

TEST(CameraFinding, AGlobalShutterStaysOne) {
  for (std::uint64_t seed = 5; seed <= 7; ++seed) {
    test::Walk walk = test::rollingWalk(seed, 20, 0, largest_motion, noise_px);
    const Map before = walk.map;
    CameraFinding finding({});
    EXPECT_FALSE(foundIn(walk, finding).readout_s) << seed;
    EXPECT_TRUE(finding.isSettled());
    EXPECT_EQ(walk.map.points.begin()->second.host_bearing, before.points.begin()->second.host_bearing);
  }
}

TEST(CameraFinding, ADistortionThatIsNotCalibratedIsFoundAndOneThatIsNearlyRightIsLeftAlone) {
  for (const double more : {0.02, 0.001}) {
    const Camera wrong = test::withDistortion(test::Walk::camera(), more);
    test::Walk walk = test::mappedWith(wrong, 12);
    CameraFinding finding({});
    for (int keyframe = 0; keyframe < 400 && !finding.isSettled(); ++keyframe) finding.look(wrong, {}, {}, walk.map);
    const bool is_far_off = more > 0.01;
    EXPECT_NEAR(test::movedAtCorner(walk.map.found),
                is_far_off ? test::movedAtCorner({std::nullopt, 1, {-more, 0}}) : 0, is_far_off ? 0.006 : 1e-12);
    EXPECT_NEAR(walk.map.found.focal_scale, 1, 1e-12);
    EXPECT_TRUE(finding.isSettled());
  }
}

TEST(CameraFinding, AFocalLengthThatIsOffIsFoundAndOneThatIsNearlyRightIsLeftAlone) {
  for (const double times : {1.09, 1.07, 1.003}) {
    const Camera wrong = test::withFocalLengths(test::Walk::camera(), times);
    test::Walk walk = test::mappedWith(wrong, 10);
    CameraFinding finding({});
    for (int keyframe = 0; keyframe < 400 && !finding.isSettled(); ++keyframe) finding.look(wrong, {}, {}, walk.map);
    const bool is_far_off = std::abs(times - 1) > 0.01;
    EXPECT_NEAR(walk.map.found.focal_scale, is_far_off ? 1 / times : 1, is_far_off ? 0.01 : 1e-9) << times;
    EXPECT_TRUE(finding.isSettled());
  }
}

TEST(CameraFinding, APrincipalPointThatIsOffIsFoundAndOneThatIsNearlyRightIsLeftAlone) {
  for (const Eigen::Vector2d& off : {Eigen::Vector2d(9, -6), Eigen::Vector2d(0.2, 0.1)}) {
    const Camera wrong = test::withPrincipalPointMoved(test::Walk::camera(), off);
    test::Walk walk = test::mappedWith(wrong, 12, test::roll_that_tells);
    CameraFinding finding({});
    for (int keyframe = 0; keyframe < 400 && !finding.isSettled(); ++keyframe) finding.look(wrong, {}, {}, walk.map);
    const bool is_far_off = off.norm() > 1;
    for (std::size_t k = 0; k < 2; ++k) {
      const double expected = is_far_off ? -off(static_cast<Eigen::Index>(k)) : 0;
      EXPECT_NEAR(walk.map.found.principal_point[k], expected, is_far_off ? 1.5 : 1e-12) << k;
    }
    EXPECT_TRUE(finding.isSettled());
  }
}

TEST(CameraFinding, APresumedFocalLengthMayBeFarOff) {
  for (const double times : {0.8, 1.25}) {
    const Camera wrong = test::withFocalLengths(test::Walk::camera(), times);
    test::Walk walk = test::mappedWith(wrong, 10);
    CameraFindingOptions options;
    options.lens_is_presumed = true;
    CameraFinding finding(options);
    for (int keyframe = 0; keyframe < 400 && !finding.isSettled(); ++keyframe) finding.look(wrong, {}, {}, walk.map);
    EXPECT_NEAR(walk.map.found.focal_scale * times, 1, 0.06) << times;
  }
}

// Looks that find nothing for long do not end the search.
TEST(CameraFinding, WhatOneMotionDoesNotTellIsFoundOnceAnotherTellsIt) {
  test::Walk silent = test::rollingWalk(5, 20, 0, largest_motion, noise_px),
             telling = test::rollingWalk(4, 20, 0.02, largest_motion, noise_px);
  CameraFinding finding({});
  for (int keyframe = 0; keyframe < 60; ++keyframe) finding.look(test::Walk::camera(), {}, {}, silent.map);
  ASSERT_EQ(silent.map.found, FoundCamera{});
  for (int keyframe = 0; keyframe < 40; ++keyframe) finding.look(test::Walk::camera(), {}, {}, telling.map);
  ASSERT_TRUE(telling.map.found.readout_s);
  EXPECT_NEAR(*telling.map.found.readout_s, 0.02, 0.0015);
}

// A readout that is found to be another one at every look, as with a wrong lens, does not hold the lens up for ever.
TEST(CameraFinding, AFocalLengthIsFoundThoughTheReadoutDoesNotComeToStay) {
  const Camera wrong = test::withFocalLengths(test::Walk::camera(), 1.09);
  test::Walk walk = test::rollingWalk(4, 20, 0.02, largest_motion, noise_px);
  takeRaysAnew(wrong, test::allKeyframes(walk.map), walk.map);
  CameraFinding finding({});
  for (int keyframe = 0; keyframe < 200; ++keyframe) {
    if (!finding.look(wrong, {}, {}, walk.map) || !walk.map.found.readout_s) continue;
    walk.map.found.readout_s = *walk.map.found.readout_s + (keyframe % 2 == 0 ? 0.004 : -0.004);
    takeRaysAnew(withFound(wrong, walk.map.found), test::allKeyframes(walk.map), walk.map);
  }
  EXPECT_NEAR(walk.map.found.focal_scale, 1 / 1.09, 0.02);
}

// It sees the same whatever the readout.
TEST(CameraFinding, ACameraThatStandsWhileItReadsTellsNothing) {
  test::Walk walk = test::rollingWalk(8, 20, 0.02, 0, noise_px);
  const auto estimate = estimateReadout(test::lookedAt(test::Walk::camera(), walk), longest_s);
  EXPECT_TRUE(!estimate || estimate->sigma > longest_s);
  CameraFinding finding({});
  EXPECT_FALSE(foundIn(walk, finding).readout_s);
}

TEST(CameraFinding, AReadoutThatIsKnownAndOneThatIsNotAskedForAreLeftAlone) {
  test::Walk walk = test::rollingWalk(9, 20, 0.02, largest_motion, noise_px);
  Camera known = test::Walk::camera();
  known.readout_s = 0.01;
  CameraFindingOptions off;
  off.readout_is_known = true;
  CameraFinding finding({}), none(off);
  for (int keyframe = 0; keyframe < 40; ++keyframe) {
    EXPECT_FALSE(finding.look(known, {}, {}, walk.map));
    EXPECT_FALSE(none.look(test::Walk::camera(), {}, {}, walk.map));
  }
  EXPECT_FALSE(walk.map.found.readout_s);
}

}  // namespace
}  // namespace edgeslam
