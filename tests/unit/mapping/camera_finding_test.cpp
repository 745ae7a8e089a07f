#include "mapping/camera_finding.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/mapping/rolling_walk.h"

namespace edgeslam {
namespace {

constexpr double motion = 0.5, noise = 0.2;
constexpr double longest_s = 0.05;

LookedAt lookedAt(const Camera& camera, const test::Walk& walk) {
  return *lookAt(camera, {}, {}, test::allKeyframes(walk.map), walk.map);
}

// Looks at the map as often as it takes.
FoundCamera foundIn(test::Walk& walk, CameraFinding& finding) {
  for (int keyframe = 0; keyframe < 400 && !finding.isSettled(); ++keyframe) {
    finding.look(test::Walk::camera(), {}, {}, walk.map);
  }
  return walk.map.found;
}

TEST(CameraFinding, TheReadoutIsThatWithWhichTheMapFits) {
  for (const double readout_s : {-0.025, 0.0, 0.012, 0.03}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const auto estimate = estimateReadout(
          lookedAt(test::Walk::camera(), test::rollingWalk(seed, 20, readout_s, motion, noise)), longest_s);
      ASSERT_TRUE(estimate);
      EXPECT_NEAR(estimate->value, readout_s, 0.0015) << seed;
      EXPECT_GT(estimate->sigma, 0);
      EXPECT_LT(estimate->sigma, 0.001);
    }
  }
}

TEST(CameraFinding, ARollingShutterIsFoundAndTheMapAdjustedToIt) {
  test::Walk walk = test::rollingWalk(4, 20, 0.02, motion, noise);
  CameraFinding finding({});
  const FoundCamera found = foundIn(walk, finding);
  ASSERT_TRUE(found.readout_s);
  EXPECT_NEAR(*found.readout_s, 0.02, 0.0015);
  EXPECT_EQ(found.focal_scale, 1);
  EXPECT_TRUE(finding.isSettled());
  double cost_found = 0, cost_global = 0;
  test::Walk as_global = test::rollingWalk(4, 20, 0.02, motion, noise);
  const std::vector<KeyframeId> all = test::allKeyframes(walk.map);
  ASSERT_TRUE(adjustKeyframes(withFound(test::Walk::camera(), found), {}, all, {}, walk.map, nullptr, &cost_found));
  ASSERT_TRUE(adjustKeyframes(test::Walk::camera(), {}, all, {}, as_global.map, nullptr, &cost_global));
  EXPECT_LT(cost_found, 0.5 * cost_global);
}

TEST(CameraFinding, AGlobalShutterStaysOne) {
  for (std::uint64_t seed = 5; seed <= 7; ++seed) {
    test::Walk walk = test::rollingWalk(seed, 20, 0, motion, noise);
    const Map before = walk.map;
    CameraFinding finding({});
    EXPECT_FALSE(foundIn(walk, finding).readout_s) << seed;
    EXPECT_TRUE(finding.isSettled());
    EXPECT_EQ(walk.map.points.begin()->second.host_bearing, before.points.begin()->second.host_bearing);
  }
}

Camera withFocalLengths(Camera camera, double times) {
  camera.fx *= times;
  camera.fy *= times;
  return camera;
}

// The map with the rays that a wrong calibration gives it.
test::Walk mappedWith(const Camera& wrong, std::uint64_t seed) {
  test::Walk walk = test::rollingWalk(seed, 20, 0, motion, noise);
  takeRaysAnew(wrong, test::allKeyframes(walk.map), walk.map);
  return walk;
}

TEST(CameraFinding, TheFocalLengthIsThatWithWhichTheMapFits) {
  for (const double times : {0.92, 1.0, 1.06}) {
    const Camera wrong = withFocalLengths(test::Walk::camera(), times);
    const auto equations = lensEquations(lookedAt(wrong, mappedWith(wrong, 3)));
    ASSERT_TRUE(equations);
    EXPECT_NEAR(estimateLens(*equations, true, false).change(0), -std::log(times), 0.01);
    EXPECT_TRUE(estimateLens(*equations, true, false).change.tail<2>().isZero(0));
  }
}

// What it moves at the corner, share of the distance from the centre.
double movedAtCorner(const FoundCamera& found) {
  const Camera camera = test::Walk::camera();
  const double x = std::max(camera.cx, camera.width - 1 - camera.cx) / camera.fx;
  const double y = std::max(camera.cy, camera.height - 1 - camera.cy) / camera.fy;
  const double squared = x * x + y * y;
  return found.radial[0] * squared + found.radial[1] * squared * squared;
}

Camera withDistortion(Camera camera, double more) {
  camera.distortion[0] += more;
  return camera;
}

TEST(CameraFinding, TheDistortionIsThatWithWhichTheMapFits) {
  for (const double more : {-0.06, 0.0, 0.08}) {
    const Camera wrong = withDistortion(test::Walk::camera(), more);
    const auto equations = lensEquations(lookedAt(wrong, mappedWith(wrong, 3)));
    ASSERT_TRUE(equations);
    for (const bool focal_length : {false, true}) {
      const LensEstimate estimate = estimateLens(*equations, focal_length, true);
      const FoundCamera found = withLens(wrong, {}, estimate.change);
      EXPECT_NEAR(movedAtCorner(found), movedAtCorner({std::nullopt, 1, {-more, 0}}), 0.006) << more;
      EXPECT_NEAR(estimate.change(0), 0, focal_length ? 0.01 : 1e-12) << more;
    }
  }
}

TEST(CameraFinding, MoreThatIsFreeFitsNoWorseAndIsKnownNoBetter) {
  const Camera wrong = withDistortion(withFocalLengths(test::Walk::camera(), 1.05), 0.05);
  const auto equations = lensEquations(lookedAt(wrong, mappedWith(wrong, 11)));
  ASSERT_TRUE(equations);
  const LensEstimate both = estimateLens(*equations, true, true);
  for (const bool focal_length : {false, true}) {
    const LensEstimate one = estimateLens(*equations, focal_length, !focal_length);
    EXPECT_GT(both.gain, one.gain);
    EXPECT_GT(one.gain, 0);
    const int free = focal_length ? 0 : 1;
    EXPECT_GE(both.covariance(free, free), one.covariance(free, free));
  }
}

TEST(CameraFinding, ADistortionThatIsNotCalibratedIsFoundAndOneThatIsNearlyRightIsLeftAlone) {
  for (const double more : {0.08, 0.004}) {
    const Camera wrong = withDistortion(test::Walk::camera(), more);
    test::Walk walk = mappedWith(wrong, 12);
    CameraFinding finding({});
    for (int keyframe = 0; keyframe < 400 && !finding.isSettled(); ++keyframe) finding.look(wrong, {}, {}, walk.map);
    const bool is_far_off = more > 0.01;
    EXPECT_NEAR(movedAtCorner(walk.map.found), is_far_off ? movedAtCorner({std::nullopt, 1, {-more, 0}}) : 0,
                is_far_off ? 0.006 : 1e-12);
    EXPECT_NEAR(walk.map.found.focal_scale, 1, 1e-12);
    EXPECT_TRUE(finding.isSettled());
  }
}

TEST(CameraFinding, ACameraWhosePixelsAreEachOfOneDirectionIsOneToOne) {
  for (const CameraModel model : {CameraModel::pinhole_radial_tangential, CameraModel::kannala_brandt}) {
    Camera camera = testCamera(model);
    camera.distortion = {};
    EXPECT_TRUE(isOneToOne(camera));
    // Turns back before the corner, and never comes as far as there.
    camera.distortion[0] = -1;
    EXPECT_FALSE(isOneToOne(camera));
    camera.distortion[0] = 0.3;
    EXPECT_TRUE(isOneToOne(camera));
    camera.distortion[0] = std::nan("");
    EXPECT_FALSE(isOneToOne(camera));
  }
  // As calibrated by others: the Kinect's.
  Camera kinect;
  kinect.width = 640, kinect.height = 480;
  kinect.fx = 517.3, kinect.fy = 516.5, kinect.cx = 318.6, kinect.cy = 255.3;
  kinect.distortion = {0.2624, -0.9531, -0.0054, 0.0026, 1.1633};
  EXPECT_TRUE(isOneToOne(kinect));
}

TEST(CameraFinding, AFocalLengthThatIsFarOffIsFoundAndOneThatIsNearlyRightIsLeftAlone) {
  for (const double times : {1.09, 1.01}) {
    test::Walk walk = test::rollingWalk(10, 20, 0, motion, noise);
    const Camera wrong = withFocalLengths(test::Walk::camera(), times);
    takeRaysAnew(wrong, test::allKeyframes(walk.map), walk.map);
    CameraFinding finding({});
    for (int keyframe = 0; keyframe < 400 && !finding.isSettled(); ++keyframe) finding.look(wrong, {}, {}, walk.map);
    EXPECT_NEAR(walk.map.found.focal_scale, times > 1.05 ? 1 / times : 1, times > 1.05 ? 0.01 : 1e-9);
    EXPECT_TRUE(finding.isSettled());
  }
}

// It sees the same whatever the readout.
TEST(CameraFinding, ACameraThatStandsWhileItReadsTellsNothing) {
  test::Walk walk = test::rollingWalk(8, 20, 0.02, 0, noise);
  const auto estimate = estimateReadout(lookedAt(test::Walk::camera(), walk), longest_s);
  EXPECT_TRUE(!estimate || estimate->sigma > longest_s);
  CameraFinding finding({});
  EXPECT_FALSE(foundIn(walk, finding).readout_s);
}

TEST(CameraFinding, AReadoutThatIsKnownAndOneThatIsNotAskedForAreLeftAlone) {
  test::Walk walk = test::rollingWalk(9, 20, 0.02, motion, noise);
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
