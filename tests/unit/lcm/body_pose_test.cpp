#include "drivers/lcm/body_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "unit/lcm/made_frames.h"

namespace edgeslam {
namespace {

Vector6d smallUpdate(Random& random, double size) {
  Vector6d update;
  update << random.vector(size), random.vector(size);
  return update;
}

// The update d with retract(from, d) = to.
Vector6d difference(const Pose& from, const Pose& to) {
  const Pose moved = from.inverse() * to;
  Vector6d update;
  update << moved.translation, rotationLog(moved.rotation);
  return update;
}

TEST(BodyPose, StartsAtTheIdentityWhereverTheCameraSits) {
  Random random(1);
  for (int i = 0; i < 50; ++i) expectSame(bodyPose(Pose(), metricRobot(randomPose(random), 0.3)), Pose(), 1e-12);
}

TEST(BodyPose, APointOfTheBodyGoesWhereTheCameraCarriesIt) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const RobotSetup robot = metricRobot(randomPose(random), random.uniform(0.1, 4));
    const Pose world_T_camera = randomPose(random);
    // A point fixed to the body, seen from the camera, in metres; where it is in the world, in metres.
    const Eigen::Vector3d in_body = random.vector(2);
    const Eigen::Vector3d in_camera = robot.body_T_camera.inverse() * in_body;
    const Eigen::Vector3d in_world =
        world_T_camera.rotation * in_camera + robot.scale.metres_per_unit * world_T_camera.translation;
    const Eigen::Vector3d in_local = robot.body_T_camera * in_world;
    EXPECT_LT((bodyPose(world_T_camera, robot) * in_body - in_local).norm(), 1e-10);
  }
}

TEST(BodyPose, WhereDownIsKnownZPointsUpAndNothingElseChanges) {
  Random random(7);
  for (int i = 0; i < 50; ++i) {
    RobotSetup robot = metricRobot(randomPose(random), random.uniform(0.1, 4));
    const Pose one = randomPose(random), other = randomPose(random);
    const Pose between = bodyPose(one, robot).inverse() * bodyPose(other, robot);
    robot.down = random.vector(1).normalized();
    EXPECT_LT((worldTurnedUp(robot) * *robot.down + Eigen::Vector3d::UnitZ()).norm(), 1e-9);
    const Eigen::Vector3d down_in_local = robot.body_T_camera.rotation * *robot.down;
    EXPECT_LT((localTurnedUp(robot) * down_in_local + Eigen::Vector3d::UnitZ()).norm(), 1e-9);
    EXPECT_LT(bodyPose(Pose(), robot).translation.norm(), 1e-9) << "the origin stays";
    expectSame(bodyPose(one, robot).inverse() * bodyPose(other, robot), between, 1e-9);
    // The camera's pose and the map go together.
    const Eigen::Vector3f point = random.vector(3).cast<float>();
    const Eigen::Vector3d in_camera = robot.scale.metres_per_unit * (one.inverse() * point.cast<double>());
    EXPECT_LT((cameraPose(one, robot) * in_camera - pointInWorld(point, robot).cast<double>()).norm(), 1e-5);
  }
}

TEST(BodyPose, WhileTheScaleIsUnknownTheLeverArmIsLeftOut) {
  Random random(3);
  RobotSetup robot;
  robot.body_T_camera = randomPose(random);
  const Pose turned{rotationExp({0, 0.7, 0}), Eigen::Vector3d::Zero()};
  EXPECT_LT(bodyPose(turned, robot).translation.norm(), 1e-12) << "turning on the spot is no way in map units";
  robot.scale = {ScaleKind::odometry, 1, 0.1};
  EXPECT_GT(bodyPose(turned, robot).translation.norm(), 1e-3);
}

TEST(BodyPose, CovarianceIsThatOfTheBodysSmallMotion) {
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const RobotSetup robot = metricRobot(randomPose(random), random.uniform(0.1, 4));
    const Pose world_T_camera = randomPose(random);
    // Of a covariance of rank one, u u', the camera moves along u; the body along the root of its covariance.
    const Vector6d update = smallUpdate(random, 1e-5);
    const Matrix6d rank_one = update * update.transpose() + 1e-18 * Matrix6d::Identity();
    const Vector6d moved =
        difference(bodyPose(world_T_camera, robot), bodyPose(retract(world_T_camera, update), robot));
    const Matrix6d expected = moved * moved.transpose();
    EXPECT_LT((bodyCovariance(rank_one, robot) - expected).norm(), 1e-3 * expected.norm());
  }
}

TEST(BodyPose, CovarianceStaysSymmetricAndPositive) {
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const Matrix6d covariance =
        bodyCovariance(randomCovariance(random), metricRobot(randomPose(random), random.uniform(0.1, 4)));
    EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-12 * covariance.norm());
    EXPECT_GT(covariance.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0);
  }
}

TEST(BodyPose, ACovarianceThatIsNoneIsUnknown) {
  Matrix6d broken = Matrix6d::Identity();
  broken(2, 3) = std::numeric_limits<double>::quiet_NaN();
  const Matrix6d unknown = unknown_variance * Matrix6d::Identity();
  EXPECT_EQ(bodyCovariance(broken, {}), unknown);
  EXPECT_EQ(bodyCovariance(Matrix6d::Zero(), {}), unknown) << "no pose is certain";
  EXPECT_EQ(bodyCovariance(-Matrix6d::Identity(), {}), unknown);
}

TEST(BodyMotion, ComposesToThePose) {
  Random random(6);
  const RobotSetup robot = metricRobot(randomPose(random), 0.4);
  Pose local_T_body;
  std::optional<MeasuredPose> before = measuredPose(measuredFrame(0, Pose()));
  Pose world_T_camera;
  for (int i = 1; i < 60; ++i) {
    world_T_camera = world_T_camera * Pose{rotationExp(random.vector(0.05)), random.vector(0.1)};
    const std::optional<MeasuredPose> now = measuredPose(measuredFrame(i, world_T_camera));
    const std::optional<BodyMotion> motion = bodyMotion(*before, *now, robot);
    ASSERT_TRUE(motion);
    local_T_body = local_T_body * motion->before_T_now;
    before = now;
  }
  expectSame(local_T_body, bodyPose(world_T_camera, robot), 1e-9);
}

TEST(BodyMotion, ACorrectionOfTheMapIsNoMotion) {
  Random random(7);
  FrameResult first = measuredFrame(0, randomPose(random)), second = measuredFrame(1, randomPose(random));
  first.reference = second.reference = 3;
  first.reference_T_camera = second.reference_T_camera = randomPose(random);
  const std::optional<BodyMotion> motion = bodyMotion(*measuredPose(first), *measuredPose(second), {});
  ASSERT_TRUE(motion);
  expectSame(motion->before_T_now, Pose(), 1e-12);
}

TEST(BodyMotion, OfPosesOnTwoKeyframesIsTheWorlds) {
  Random random(17);
  FrameResult first = measuredFrame(0, randomPose(random)), second = measuredFrame(1, randomPose(random));
  first.reference = 3;
  second.reference = 4;
  first.reference_T_camera = second.reference_T_camera = randomPose(random);
  const std::optional<BodyMotion> motion = bodyMotion(*measuredPose(first), *measuredPose(second), {});
  ASSERT_TRUE(motion);
  expectSame(motion->before_T_now, first.world_T_camera.inverse() * second.world_T_camera, 1e-12);
}

TEST(BodyMotion, TooLongAgoOrBackwardsIsNone) {
  const MeasuredPose before = *measuredPose(measuredFrame(10, Pose()));
  EXPECT_FALSE(bodyMotion(before, before, {}));
  EXPECT_FALSE(bodyMotion(before, *measuredPose(measuredFrame(9, Pose())), {}));
  EXPECT_TRUE(bodyMotion(before, *measuredPose(measuredFrame(25, Pose())), {}));
  EXPECT_FALSE(bodyMotion(before, *measuredPose(measuredFrame(26, Pose())), {}));
}

TEST(MeasuredPose, IsNoneWhereThePositionIsHeld) {
  FrameResult frame = measuredFrame(10, Pose());
  EXPECT_TRUE(measuredPose(frame));
  frame.position_is_held = true;
  EXPECT_FALSE(measuredPose(frame));
}

TEST(BodyMotion, CovarianceIsThatOfBothPosesErrors) {
  Random random(8);
  const RobotSetup robot = metricRobot(randomPose(random), 0.7);
  const Pose before_pose = randomPose(random), now_pose = randomPose(random);
  const Vector6d error = smallUpdate(random, 1e-5);
  FrameResult before = measuredFrame(0, before_pose), now = measuredFrame(1, now_pose);
  before.covariance = error * error.transpose() + 1e-18 * Matrix6d::Identity();
  now.covariance = 1e-18 * Matrix6d::Identity();
  const BodyMotion motion = *bodyMotion(*measuredPose(before), *measuredPose(now), robot);

  FrameResult moved = before;
  moved.world_T_camera = retract(before_pose, error);
  const Vector6d change =
      difference(motion.before_T_now, bodyMotion(*measuredPose(moved), *measuredPose(now), robot)->before_T_now);
  const Matrix6d expected = change * change.transpose();
  EXPECT_LT((motion.covariance - expected).norm(), 1e-3 * expected.norm());
}

TEST(MeasuredPose, OnlyOfAGoodFinitePose) {
  EXPECT_TRUE(measuredPose(measuredFrame(0, Pose())));
  for (const TrackingState state : {TrackingState::initialising, TrackingState::predicted, TrackingState::lost}) {
    FrameResult frame = measuredFrame(0, Pose());
    frame.state = state;
    EXPECT_FALSE(measuredPose(frame)) << stateName(state);
  }
  FrameResult broken = measuredFrame(0, Pose());
  broken.world_T_camera.translation.x() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(measuredPose(broken));
  broken = measuredFrame(0, Pose());
  broken.world_T_camera.rotation.coeffs().setZero();
  EXPECT_FALSE(measuredPose(broken));
}

}  // namespace
}  // namespace edgeslam
