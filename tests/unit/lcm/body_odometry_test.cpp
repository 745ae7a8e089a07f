// The body in a frame that never jumps, and where that frame is in `local`.
#include "drivers/lcm/body_odometry.h"

#include <gtest/gtest.h>

#include "unit/lcm/made_frames.h"
#include "unit/visual_odometry/moving_camera.h"
#include "wheels/utime.h"

namespace edgeslam {
namespace {

const Pose twist_a_frame{rotationExp({0, 0.03, 0}), {0.02, 0, 0.05}};
const Pose on_body{rotationExp({-1.2, 1.2, -1.2}), {0.2, 0.05, 0.4}};

Pose poseOf(const double (&p)[3], const double (&q)[4]) { return {{q[0], q[1], q[2], q[3]}, {p[0], p[1], p[2]}}; }
Pose odomTBody(const OdometryMessages& messages) {
  return poseOf(messages.odometry.pos, messages.odometry.orientation);
}
Pose localTOdom(const OdometryMessages& messages) {
  return poseOf(messages.correction.translation, messages.correction.rotation);
}

TEST(BodyOdometry, MovedByItsCorrectionItIsThePose) {
  test::MovingCamera camera(twist_a_frame);
  BodyOdometry odometry;
  const RobotSetup robot = metricRobot(on_body, 0.4);
  for (int i = 0; i < 60; ++i) {
    if (i == 30) camera.correctMap({rotationExp({0, 0.1, 0}), {1, 0, 0.5}});
    const FrameResult frame = i % 9 == 5 ? camera.predicted({0.01, 0, 0}) : camera.tracked();
    const auto messages = odometry.next(frame, robot);
    ASSERT_TRUE(messages);
    expectSame(localTOdom(*messages) * odomTBody(*messages), bodyPose(frame.world_T_camera, robot));
  }
}

TEST(BodyOdometry, MovesAsTheBodyDoes) {
  test::MovingCamera camera(twist_a_frame);
  BodyOdometry odometry;
  const RobotSetup robot = metricRobot(on_body, 0.4);
  const auto first = odometry.next(camera.tracked(), robot);
  const auto second = odometry.next(camera.tracked(), robot);
  ASSERT_TRUE(first && second);
  expectSame(odomTBody(*first), Pose());
  const Pose moved = odomTBody(*second);
  expectSame(moved, on_body * Pose{twist_a_frame.rotation, 0.4 * twist_a_frame.translation} * on_body.inverse());
  const double seconds = 1e-9 * test::frame_interval_ns;
  const Eigen::Vector3d velocity(second->odometry.vel[0], second->odometry.vel[1], second->odometry.vel[2]);
  EXPECT_LT((moved.rotation * velocity * seconds - moved.translation).norm(), 1e-9) << "in the body's frame";
}

TEST(BodyOdometry, SaysWhenItsCorrectionChangedAndWhy) {
  test::MovingCamera camera(twist_a_frame);
  BodyOdometry odometry;
  const RobotSetup robot = metricRobot(on_body, 0.4);
  const auto correctionOf = [&](const FrameResult& frame) { return odometry.next(frame, robot)->correction; };
  FrameResult frame = camera.tracked();
  correction_t correction = correctionOf(frame);
  EXPECT_EQ(correction.change, correction_t::START);
  EXPECT_EQ(correction.change_utime, utimeOf(frame.time_ns));
  const std::int64_t start = correction.change_utime;
  for (int i = 0; i < 10; ++i) correction = correctionOf(camera.tracked());
  EXPECT_EQ(correction.change_utime, start);
  EXPECT_EQ(correction.change, correction_t::START);

  camera.correctMap({Eigen::Quaterniond::Identity(), {1, 0, 0}});
  frame = camera.tracked();
  correction = correctionOf(frame);
  EXPECT_EQ(correction.change, correction_t::MAP_CORRECTED);
  EXPECT_EQ(correction.change_utime, utimeOf(frame.time_ns));
  EXPECT_EQ(correction.reset_count, 0);

  frame = camera.tracked();
  frame.world_T_camera.translation.x() += 0.1;
  EXPECT_EQ(correctionOf(frame).change, correction_t::MAP_ADJUSTED);

  EXPECT_FALSE(correctionOf(camera.predicted({0.1, 0, 0})).is_measured);
  EXPECT_EQ(correctionOf(camera.tracked()).change, correction_t::MEASURED_AGAIN);
  frame = camera.tracked();
  correction = correctionOf(frame);
  EXPECT_EQ(correction.change, correction_t::MEASURED_AGAIN) << "it is taken back over half a second";
  EXPECT_EQ(correction.change_utime, utimeOf(frame.time_ns));

  camera.enterWorld(1);
  correction = correctionOf(camera.tracked());
  EXPECT_EQ(correction.change, correction_t::ANOTHER_WORLD);
  EXPECT_EQ(correction.world, 1);
  EXPECT_EQ(correction.reset_count, 1);

  frame = camera.tracked();
  frame.state = TrackingState::relocalised;
  frame.world_T_camera.translation.x() += 0.1;
  EXPECT_EQ(correctionOf(frame).change, correction_t::FOUND_AGAIN);
}

TEST(BodyOdometry, MetresInPlaceOfMapUnitsAreAReset) {
  test::MovingCamera camera(twist_a_frame);
  BodyOdometry odometry;
  RobotSetup robot;
  robot.body_T_camera = on_body;
  for (int i = 0; i < 5; ++i) odometry.next(camera.tracked(), robot);
  const Pose before = odomTBody(*odometry.next(camera.tracked(), robot));
  const auto known = odometry.next(camera.tracked(), metricRobot(on_body, 0.4));
  ASSERT_TRUE(known);
  expectSame(odomTBody(*known), before);
  EXPECT_EQ(known->correction.reset_count, 1);
  EXPECT_EQ(known->correction.change, correction_t::SCALE);
}

TEST(BodyOdometry, AScaleThatIsFollowedMovesTheCorrectionAlone) {
  test::MovingCamera camera(twist_a_frame);
  BodyOdometry odometry;
  for (int i = 0; i < 100; ++i) odometry.next(camera.tracked(), metricRobot(on_body, 0.4));
  const Pose before = odomTBody(*odometry.next(camera.tracked(), metricRobot(on_body, 0.4)));
  const auto later = odometry.next(camera.tracked(), metricRobot(on_body, 0.4004));
  ASSERT_TRUE(later);
  const Pose moved = before.inverse() * odomTBody(*later);
  EXPECT_NEAR(
      moved.translation.norm(),
      (on_body * Pose{twist_a_frame.rotation, 0.4 * twist_a_frame.translation} * on_body.inverse()).translation.norm(),
      1e-4);
  EXPECT_EQ(later->correction.change, correction_t::SCALE);
  EXPECT_EQ(later->correction.reset_count, 0);
}

TEST(BodyOdometry, AFrameThatWasLostLeavesTheCorrectionAsItWas) {
  test::MovingCamera camera(twist_a_frame);
  BodyOdometry odometry;
  const RobotSetup robot = metricRobot(on_body, 0.4);
  for (int i = 0; i < 5; ++i) odometry.next(camera.tracked(), robot);
  const auto before = odometry.next(camera.tracked(), robot), lost = odometry.next(camera.lost(), robot);
  ASSERT_TRUE(before && lost);
  expectSame(localTOdom(*lost), localTOdom(*before));
  EXPECT_FALSE(lost->correction.is_measured);
  EXPECT_EQ(lost->correction.world, before->correction.world);
}

}  // namespace
}  // namespace edgeslam
