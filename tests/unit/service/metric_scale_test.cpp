#include "service/metric_scale.h"

#include "unit/lcm/made_frames.h"
#include "unit/service/made_service.h"
#include "wheels/utime.h"

namespace edgeslam {
namespace {

class MetricScaleTest : public MadeService {
 protected:
  // Along x, 0.1 map units a frame; then "from the first frame to the last it was 2 m".
  CommandOutcome walkAndSet(MetricScale& scale) {
    for (int i = 0; i <= 40; ++i) scale.frame(measuredFrame(i, {Eigen::Quaterniond::Identity(), {0.1 * i, 0, 0}}));
    Command command;
    command.kind = CommandKind::set_scale;
    command.from_utime = utimeOf(measuredFrame(0, Pose()).time_ns);
    command.to_utime = utimeOf(measuredFrame(40, Pose()).time_ns);
    command.distance_m = 2;
    return scale.set(command);
  }

  ScaleOptions options_;
};

TEST_F(MetricScaleTest, ADistanceSetsItAndAnotherMapForgetsIt) {
  MetricScale scale(options_, Pose(), publisher_, work_, log_);
  EXPECT_FALSE(scale.isKnown());
  const CommandOutcome outcome = walkAndSet(scale);
  EXPECT_TRUE(outcome.accepted) << outcome.message;
  EXPECT_TRUE(scale.isKnown());
  EXPECT_NEAR(publisher_.scale().metres_per_unit, 0.5, 1e-9);
  EXPECT_EQ(scale.problem(), "");
  scale.forget();
  EXPECT_FALSE(scale.isKnown());
  EXPECT_EQ(publisher_.scale().kind, ScaleKind::unknown);
  EXPECT_EQ(said(), "edgeslam: " + outcome.message + "\nedgeslam: the scale is unknown again: another map was begun\n");
}

FrameResult frameWithInertia(int index, double metres_a_unit, const Eigen::Vector3d& down) {
  FrameResult frame = measuredFrame(index, Pose());
  frame.inertia = InertialAlignment();
  frame.inertia->is_known = true;
  frame.inertia->metres_a_unit = metres_a_unit;
  frame.inertia->scale_sigma = 0.01;
  frame.inertia->gravity = standard_gravity * down;
  return frame;
}

TEST_F(MetricScaleTest, InertiaTellsItAtOnceAndItMovesSlowlyFromThenOn) {
  MetricScale scale(options_, Pose(), publisher_, work_, log_);
  scale.frame(measuredFrame(0, Pose()));
  scale.mapLacks("inertia: the map is too young for its scale");
  EXPECT_NE(scale.problem().find("too young"), std::string::npos);
  scale.frame(frameWithInertia(1, 2, Eigen::Vector3d::UnitY()));
  EXPECT_EQ(publisher_.scale().kind, ScaleKind::inertia);
  EXPECT_NEAR(publisher_.scale().metres_per_unit, 2, 1e-9);
  ASSERT_TRUE(publisher_.robot().down);
  EXPECT_EQ(*publisher_.robot().down, Eigen::Vector3d::UnitY());
  const Eigen::Vector3d a_little_off = Eigen::Vector3d(0.005, 1, 0).normalized();
  scale.frame(frameWithInertia(2, 2.2, a_little_off));
  EXPECT_NEAR(publisher_.scale().metres_per_unit, 2, 1e-9) << "once a second";
  EXPECT_EQ(*publisher_.robot().down, Eigen::Vector3d::UnitY()) << "up stays";
  for (int second = 0; second < 10; ++second) scale.everySecond(second, false);
  EXPECT_NEAR(publisher_.scale().metres_per_unit, 2 * std::exp(10 * GradualScale::largest_step), 1e-3);
  scale.frame(frameWithInertia(3, 2.2, Eigen::Vector3d(0.1, 1, 0).normalized()));
  EXPECT_GT(publisher_.robot().down->x(), 0.05) << "but where it was wrong";
}

// A unit that contradicts the camera: the map no longer knows it. A lost frame says nothing of that.
TEST_F(MetricScaleTest, WhatInertiaNoLongerKnowsIsUnknownAgain) {
  MetricScale scale(options_, Pose(), publisher_, work_, log_);
  scale.frame(measuredFrame(0, Pose()));
  scale.frame(frameWithInertia(1, 2, Eigen::Vector3d::UnitY()));
  scale.frame(frameWithoutPose(2, TrackingState::lost, "dark"));
  EXPECT_EQ(publisher_.scale().kind, ScaleKind::inertia);
  FrameResult unknown = frameWithInertia(3, 2, Eigen::Vector3d::UnitY());
  unknown.inertia->is_known = false;
  scale.frame(unknown);
  EXPECT_FALSE(scale.isKnown());
  EXPECT_EQ(publisher_.scale().kind, ScaleKind::unknown);
  EXPECT_FALSE(publisher_.robot().down);
  FrameResult still_unknown = frameWithInertia(4, 2, Eigen::Vector3d::UnitY());
  still_unknown.inertia->is_known = false;
  scale.frame(still_unknown);
  const std::string told = said();
  const std::size_t first = told.find("the scale is unknown again: the inertial unit contradicts the camera\n");
  ASSERT_NE(first, std::string::npos) << told;
  EXPECT_EQ(told.find("contradicts", told.find('\n', first)), std::string::npos) << "told once: " << told;
}

FrameResult frameWithWheels(int index, double metres_a_unit) {
  FrameResult frame = measuredFrame(index, Pose());
  frame.wheels = {true, metres_a_unit, 0.02};
  return frame;
}

TEST_F(MetricScaleTest, WheelsInTheMapTellItAtOnceAndWhatItIsSearchedByDoesNotCount) {
  options_.source = "camera_height";
  options_.height.camera_height_m = 0.3;
  MetricScale scale(options_, Pose(), publisher_, work_, log_);
  scale.frame(measuredFrame(0, Pose()));
  scale.mapLacks("wheels: 1 of 3 stretches of 0.06 m driven that tell the scale");
  EXPECT_NE(scale.problem().find("1 of 3 stretches"), std::string::npos);
  scale.frame(frameWithWheels(1, 2));
  EXPECT_EQ(publisher_.scale().kind, ScaleKind::odometry);
  EXPECT_NEAR(publisher_.scale().metres_per_unit, 2, 1e-9);
  EXPECT_FALSE(publisher_.robot().down) << "wheels do not tell it";
  scale.frame(frameWithWheels(2, 2.2));
  EXPECT_NEAR(publisher_.scale().metres_per_unit, 2, 1e-9) << "once a second";
  for (int second = 0; second < 10; ++second) scale.everySecond(second, false);
  EXPECT_NEAR(publisher_.scale().metres_per_unit, 2 * std::exp(10 * GradualScale::largest_step), 1e-3);
  EXPECT_EQ(said().find("metres a map unit"), said().rfind("metres a map unit")) << "told once";
}

TEST_F(MetricScaleTest, InertiaDoesNotMoveWhatWasCommanded) {
  MetricScale scale(options_, Pose(), publisher_, work_, log_);
  walkAndSet(scale);
  scale.frame(frameWithInertia(41, 2, Eigen::Vector3d::UnitY()));
  scale.everySecond(1, false);
  EXPECT_NEAR(publisher_.scale().metres_per_unit, 0.5, 1e-9);
  EXPECT_TRUE(publisher_.robot().down);
}

TEST_F(MetricScaleTest, ADistanceBetweenFramesOfTwoMapsIsRefused) {
  MetricScale scale(options_, Pose(), publisher_, work_, log_);
  scale.frame(measuredFrame(0, Pose()));
  scale.mapWasCorrected();
  Command command;
  command.kind = CommandKind::set_scale;
  command.from_utime = utimeOf(measuredFrame(0, Pose()).time_ns);
  command.to_utime = command.from_utime + 1000000;
  command.distance_m = 1;
  const CommandOutcome outcome = scale.set(command);
  EXPECT_FALSE(outcome.accepted);
  EXPECT_FALSE(outcome.message.empty());
  EXPECT_FALSE(scale.isKnown());
}

FrameResult frameIn(int world, int index, TrackingState state = TrackingState::tracking) {
  FrameResult frame = measuredFrame(index, {Eigen::Quaterniond::Identity(), {0.1 * index, 0, 0}});
  frame.world = world;
  frame.state = state;
  return frame;
}

TEST_F(MetricScaleTest, EachWorldHasItsOwn) {
  MetricScale scale(options_, Pose(), publisher_, work_, log_);
  walkAndSet(scale);  // in world 0
  scale.beforeFrame(frameIn(1, 41));
  EXPECT_FALSE(scale.isKnown());
  EXPECT_EQ(publisher_.scale().kind, ScaleKind::unknown);
  for (int i = 41; i <= 81; ++i) scale.frame(frameIn(1, i));
  scale.beforeFrame(frameIn(0, 82, TrackingState::relocalised));
  EXPECT_TRUE(scale.isKnown());
  EXPECT_NEAR(publisher_.scale().metres_per_unit, 0.5, 1e-9);
  scale.beforeFrame(frameWithoutPose(83, TrackingState::lost, "dark"));
  EXPECT_TRUE(scale.isKnown()) << "no pose, no other world";

  Command command;  // of the world that the camera has left
  command.kind = CommandKind::set_scale;
  command.from_utime = utimeOf(frameIn(1, 41).time_ns);
  command.to_utime = utimeOf(frameIn(1, 81).time_ns);
  command.distance_m = 12;
  const CommandOutcome outcome = scale.set(command);
  EXPECT_TRUE(outcome.accepted);
  EXPECT_NE(outcome.message.find("a map that the camera is not in now"), std::string::npos) << outcome.message;
  EXPECT_NEAR(publisher_.scale().metres_per_unit, 0.5, 1e-9);
  scale.beforeFrame(frameIn(1, 84, TrackingState::relocalised));
  EXPECT_NEAR(publisher_.scale().metres_per_unit, 3, 1e-9);

  command.from_utime = utimeOf(frameIn(0, 0).time_ns);
  EXPECT_FALSE(scale.set(command).accepted) << "from one world to the other";
}

TEST_F(MetricScaleTest, WhileTheNextMapIsLookedForItIsUnknown) {
  MetricScale scale(options_, Pose(), publisher_, work_, log_);
  walkAndSet(scale);
  scale.noMap();
  EXPECT_FALSE(scale.isKnown());
  EXPECT_EQ(publisher_.scale().kind, ScaleKind::unknown);
  scale.beforeFrame(frameIn(0, 50, TrackingState::relocalised));
  EXPECT_TRUE(scale.isKnown()) << "the map was there all the time";
  scale.noMap();
  scale.beforeFrame(frameIn(0, 60, TrackingState::tracking));
  EXPECT_FALSE(scale.isKnown()) << "another map that began under the same number";
}

TEST_F(MetricScaleTest, ASavedMapBringsWhatIsConfigured) {
  MetricScale none(options_, Pose(), publisher_, work_, log_);
  none.takeConfigured();
  EXPECT_FALSE(none.isKnown());
  options_.metres_per_unit = 0.25;
  options_.sigma = 0.03;
  MetricScale scale(options_, Pose(), publisher_, work_, log_);
  scale.takeConfigured();
  EXPECT_TRUE(scale.isKnown());
  EXPECT_EQ(publisher_.scale().metres_per_unit, 0.25);
  EXPECT_EQ(publisher_.scale().sigma, 0.03);
}

TEST_F(MetricScaleTest, TheMapIsWantedForTheGroundOnceItHasPoints) {
  options_.source = "camera_height";
  options_.height.camera_height_m = 0.3;
  MetricScale scale(options_, Pose(), publisher_, work_, log_);
  EXPECT_FALSE(scale.everySecond(0, /*has_points=*/false));
  EXPECT_TRUE(scale.everySecond(1, /*has_points=*/true));
  EXPECT_FALSE(scale.everySecond(2, /*has_points=*/true)) << "it was asked for a second ago";
  scale.mapCame(std::make_shared<const Map>());
  finishWork();
  EXPECT_FALSE(scale.isKnown());
}

TEST_F(MetricScaleTest, AProblemIsToldOnceForAMap) {
  options_.source = "odometry";
  MetricScale scale(options_, Pose(), publisher_, work_, log_);
  ASSERT_NE(scale.problem(), "");
  for (int i = 0; i < 3; ++i) scale.everySecond(i, false);
  EXPECT_EQ(said(), "edgeslam: the scale is not known yet: " + scale.problem() + "\n");
}

}  // namespace
}  // namespace edgeslam
