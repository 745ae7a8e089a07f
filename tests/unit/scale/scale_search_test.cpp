#include "scale/scale_search.h"

#include <gtest/gtest.h>

#include "unit/scale/driven_robot.h"

namespace edgeslam {
namespace {

ScaleOptions fromOdometry() {
  ScaleOptions options;
  options.source = "odometry";
  options.odometry.channel = "WHEELS";
  return options;
}

ScaleOptions fromHeight() {
  ScaleOptions options;
  options.source = "camera_height";
  options.height.camera_height_m = 0.5;
  return options;
}

GroundPlane groundAt(double height, double sigma = 0.02) {
  GroundPlane ground;
  ground.height = height;
  ground.sigma = sigma;
  ground.points = 100;
  return ground;
}

// Takes what a drive gives as the publisher does: each frame with its result.
struct SearchTakes {
  ScaleSearch& search;
  std::int64_t index = 0;

  void add(const OdometryPose& pose) { search.add(pose); }
  void add(const MeasuredPose& frame) {
    FrameResult result = measuredFrame(index++, frame.world_T_camera);
    result.time_ns = frame.time_ns;
    result.covariance = frame.covariance_camera;
    search.add(result);
  }
};

TEST(ScaleSearch, WithoutASourceThereIsNothingToSay) {
  ScaleSearch search({}, Pose());
  EXPECT_FALSE(search.everySecond());
  EXPECT_EQ(search.problem(), "");
  EXPECT_FALSE(search.wantsMap(1e6));
}

TEST(ScaleSearch, TheOdometrysScaleComesAfterAWayAndIsForgottenWithItsMap) {
  const DrivenRobot robot;
  ScaleSearch search(fromOdometry(), robot.body_T_camera);
  EXPECT_FALSE(search.everySecond());
  EXPECT_NE(search.problem(), "");
  SearchTakes takes{search};
  playBack(drive(robot, 1), takes);
  const std::optional<ScaleState> found = search.everySecond();
  ASSERT_TRUE(found) << search.problem();
  EXPECT_EQ(found->kind, ScaleKind::odometry);
  EXPECT_NEAR(found->metres_per_unit, robot.metres_per_unit, 0.03 * robot.metres_per_unit);
  EXPECT_EQ(search.problem(), "");
  search.mapWasCorrected();
  ASSERT_TRUE(search.everySecond()) << "what is known stays";
  EXPECT_EQ(search.everySecond()->metres_per_unit, found->metres_per_unit);
  search.forget();
  EXPECT_FALSE(search.everySecond());
}

TEST(ScaleSearch, WheelsThatWentOnSlippingMakeTheScaleDoubtful) {
  DrivenRobot robot;
  ScaleSearch search(fromOdometry(), robot.body_T_camera);
  robot.seconds = 12;
  SearchTakes takes{search};
  playBack(drive(robot, 1), takes);
  const std::optional<ScaleState> before = search.everySecond();
  ASSERT_TRUE(before);
  EXPECT_LT(before->sigma, 0.1);
  robot.seconds = 9;
  robot.spin = [](double) { return 0.8; };
  Drive slipping = drive(robot, 1);
  for (MeasuredPose& frame : slipping.frames) frame.time_ns += 60'000'000'000;
  for (OdometryPose& pose : slipping.odometry) pose.utime += 60'000'000;
  playBack(slipping, takes);
  const std::optional<ScaleState> after = search.everySecond();
  ASSERT_TRUE(after);
  EXPECT_GT(after->sigma, 0.1);
  EXPECT_NE(search.problem(), "");
  EXPECT_NEAR(after->metres_per_unit, before->metres_per_unit, 0.002 * before->metres_per_unit) << "no jump";
}

TEST(ScaleSearch, TheGroundMustBeSeenThreeTimes) {
  ScaleSearch search(fromHeight(), Pose());
  EXPECT_TRUE(search.wantsMap(0));
  for (int look = 0; look < 3; ++look) {
    EXPECT_FALSE(search.everySecond());
    EXPECT_NE(search.problem(), "") << look;
    search.add(groundAt(0.25));
  }
  const std::optional<ScaleState> found = search.everySecond();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, ScaleKind::camera_height);
  EXPECT_DOUBLE_EQ(found->metres_per_unit, 2);
  EXPECT_GT(found->sigma, std::hypot(0.019, 0.01 / 0.5)) << "looks share points, and the height is measured by hand";
  EXPECT_EQ(search.problem(), "");
}

TEST(ScaleSearch, GroundsThatContradictEachOtherAreNoScale) {
  ScaleSearch search(fromHeight(), Pose());
  for (int look = 0; look < 8; ++look) search.add(groundAt(0.1 + 0.1 * look));
  EXPECT_FALSE(search.everySecond());
  EXPECT_NE(search.problem(), "");
}

TEST(ScaleSearch, AGroundThatIsSeenNowAndThenIsNone) {
  ScaleSearch search(fromHeight(), Pose());
  GroundPlane none;
  none.problem = "no ground seen";
  for (int look = 0; look < 20; ++look) {
    search.add(groundAt(0.25));
    search.add(none);
  }
  EXPECT_FALSE(search.everySecond());
}

TEST(ScaleSearch, WhyThereIsNoGroundIsTold) {
  ScaleSearch search(fromHeight(), Pose());
  GroundPlane none;
  none.problem = "no ground seen";
  search.add(none);
  EXPECT_FALSE(search.everySecond());
  EXPECT_EQ(search.problem(), "no ground seen");
}

TEST(ScaleSearch, MapsAreAskedForLessOftenOnceTheScaleIsKnown) {
  ScaleSearch search(fromHeight(), Pose());
  search.mapComes(100);
  EXPECT_FALSE(search.wantsMap(101));
  EXPECT_TRUE(search.wantsMap(102));
  for (int look = 0; look < 3; ++look) search.add(groundAt(0.25));
  search.everySecond();
  EXPECT_FALSE(search.wantsMap(109));
  EXPECT_TRUE(search.wantsMap(110));
  search.forget();
  EXPECT_TRUE(search.wantsMap(102));
}

}  // namespace
}  // namespace edgeslam
