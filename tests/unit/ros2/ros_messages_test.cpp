#include "drivers/ros2/ros_messages.h"

#include <gtest/gtest.h>

#include "unit/lcm/made_frames.h"

namespace edgeslam {
namespace {

constexpr std::int64_t stamp_ns = 1'700'000'000'123'456'000;

// The frames of a run, as LcmPublisher sends them.
class SentFrames {
 public:
  explicit SentFrames(RobotSetup robot) : robot_(std::move(robot)) {}

  SentFrame next(const FrameResult& result) {
    SentFrame sent{frameMessages(result, robot_, before_, 0, 0), odometry_.next(result, robot_)};
    if (const std::optional<MeasuredPose> measured = measuredPose(result)) before_ = measured;
    return sent;
  }

 private:
  RobotSetup robot_;
  std::optional<MeasuredPose> before_;
  BodyOdometry odometry_;
};

const Pose forward_camera{Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.2, 0, 0.4}};  // on a robot: x ahead, z up

RobotSetup metricForwardRobot() { return metricRobot(forward_camera, 0.5); }

// The camera drives ahead by 1 map unit a second.
FrameResult drivenFrame(int index) {
  FrameResult frame = measuredFrame(index, {Eigen::Quaterniond::Identity(), {0, 0, 1e-9 * frame_interval_ns * index}});
  frame.previous_time_ns = frame.time_ns - frame_interval_ns;
  frame.previous_T_camera = {Eigen::Quaterniond::Identity(), {0, 0, 1e-9 * frame_interval_ns}};
  frame.has_motion = index > 0;
  return frame;
}

Matrix6d matrixOf(const RosCovariance& rows) {
  return Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(rows.data());
}

TEST(RosMessages, AheadIsX) {
  SentFrames frames(metricForwardRobot());
  RosFrame frame;
  for (int i = 0; i <= 30; ++i) frame = rosFrame(frames.next(drivenFrame(i)), {}, stamp_ns);
  ASSERT_TRUE(frame.pose && frame.odometry);
  EXPECT_EQ(frame.pose->frame, "map");
  EXPECT_EQ(frame.pose->stamp_ns, stamp_ns);
  EXPECT_NEAR((frame.pose->pose.translation - Eigen::Vector3d(0.5, 0, 0)).norm(), 0, 1e-6)
      << "half a metre in a second";
  EXPECT_EQ(frame.odometry->pose.frame, "odom");
  EXPECT_EQ(frame.odometry->body_frame, "base_link");
  EXPECT_NEAR((frame.odometry->velocity - Eigen::Vector3d(0.5, 0, 0)).norm(), 0, 1e-6);
  EXPECT_NEAR(frame.odometry->rotation_rate.norm(), 0, 1e-9);
}

TEST(RosMessages, TransformsGoTogetherWithThePose) {
  Random random(3);
  SentFrames frames(metricRobot(randomPose(random), 0.7));
  for (int i = 0; i < 20; ++i) {
    const Pose world_T_camera{random.rotation(0.05 * i), {0.1 * i, random.uniform(0, 0.1), 0}};
    const RosFrame frame = rosFrame(frames.next(measuredFrame(i, world_T_camera)), {}, stamp_ns);
    ASSERT_TRUE(frame.map_T_odom && frame.odom_T_body && frame.map_T_body && frame.pose);
    EXPECT_EQ(frame.map_T_odom->parent, "map");
    EXPECT_EQ(frame.map_T_odom->child, frame.odom_T_body->parent);
    EXPECT_EQ(frame.odom_T_body->child, "base_link");
    expectSame(frame.map_T_odom->pose * frame.odom_T_body->pose, frame.pose->pose);
    expectSame(frame.map_T_body->pose, frame.pose->pose);
    expectSame(frame.odometry->pose.pose, frame.odom_T_body->pose);
  }
}

TEST(RosMessages, TheCovarianceIsThatOfLcmAboutTheAxesOfTheMap) {
  Random random(4);
  SentFrames frames(metricForwardRobot());
  FrameResult result = measuredFrame(0, randomPose(random));
  result.world_covariance = randomCovariance(random);
  const SentFrame sent = frames.next(result);
  const RosFrame frame = rosFrame(sent, {}, stamp_ns);
  Matrix6d of_body;
  for (int i = 0; i < 36; ++i) of_body(i / 6, i % 6) = sent.frame.state.covariance[i / 6][i % 6];
  const Matrix6d expected = withScaleError(inParent(of_body, frame.pose->pose.rotation), frame.pose->pose.translation,
                                           sent.frame.state.scale_sigma);
  EXPECT_TRUE(matrixOf(frame.pose->covariance).isApprox(expected, 1e-12));
  EXPECT_GT(sent.frame.state.scale_sigma, 0);
}

TEST(RosMessages, WhereMetresAreNotKnownNoPositionIs) {
  SentFrames frames({forward_camera, {}});
  frames.next(drivenFrame(0));
  const RosFrame frame = rosFrame(frames.next(drivenFrame(1)), {}, stamp_ns);
  for (const RosCovariance& covariance :
       {frame.pose->covariance, frame.odometry->pose.covariance, frame.odometry->twist_covariance}) {
    EXPECT_EQ((matrixOf(covariance).topLeftCorner<3, 3>()), unknown_variance * Eigen::Matrix3d::Identity());
    EXPECT_LT(matrixOf(covariance)(3, 3), 1) << "the rotation is known";
  }
}

TEST(RosMessages, AVelocityThatWasNotMeasuredIsNotKnown) {
  SentFrames frames(metricForwardRobot());
  const RosFrame first = rosFrame(frames.next(drivenFrame(0)), {}, stamp_ns);
  EXPECT_EQ(matrixOf(first.odometry->twist_covariance), unknown_variance * Matrix6d::Identity());
  const RosFrame second = rosFrame(frames.next(drivenFrame(1)), {}, stamp_ns);
  EXPECT_LT(matrixOf(second.odometry->twist_covariance)(0, 0), 1);
  EXPECT_GT(matrixOf(second.odometry->twist_covariance)(0, 0), 0);
}

TEST(RosMessages, WithoutAPoseThereIsNone) {
  SentFrames frames(metricForwardRobot());
  const RosFrame frame =
      rosFrame(frames.next(frameWithoutPose(0, TrackingState::initialising, "no map yet")), {}, stamp_ns);
  EXPECT_FALSE(frame.pose || frame.odometry || frame.map_T_odom || frame.odom_T_body || frame.map_T_body);
}

TEST(RosMessages, AnotherWorldIsAnotherFrame) {
  SentFrames frames(metricForwardRobot());
  FrameResult result = measuredFrame(0, Pose());
  result.world = 2;
  const SentFrame sent = frames.next(result);
  const RosFrame frame = rosFrame(sent, {}, stamp_ns);
  EXPECT_EQ(frame.pose->frame, "map_2");
  EXPECT_EQ(frame.map_T_odom->parent, "map_2");
  EXPECT_EQ(frame.odometry->pose.frame, "odom");
}

TEST(RosMessages, APredictedPoseIsNoMeasuredOne) {
  SentFrames frames(metricForwardRobot());
  frames.next(drivenFrame(0));
  FrameResult result = drivenFrame(1);
  result.state = TrackingState::predicted;
  const RosFrame frame = rosFrame(frames.next(result), {}, stamp_ns);
  EXPECT_FALSE(frame.pose);
  EXPECT_TRUE(frame.map_T_body);
}

TEST(RosMessages, FramesAreNamedAsConfigured) {
  Ros2Options options;
  options.map_frame = "hall";
  options.odom_frame = "robot1/odom";
  options.body_frame = "robot1/base_footprint";
  SentFrames frames(metricForwardRobot());
  const RosFrame frame = rosFrame(frames.next(drivenFrame(0)), options, stamp_ns);
  EXPECT_EQ(frame.pose->frame, "hall");
  EXPECT_EQ(frame.odometry->pose.frame, "robot1/odom");
  EXPECT_EQ(frame.odometry->body_frame, "robot1/base_footprint");
}

TEST(RosMessages, PointsAreWhereThePosesSay) {
  const RobotSetup robot = metricForwardRobot();
  PublishedPoint ahead;
  ahead.position = {0, 0, 4};  // map units before the first keyframe's camera
  const RosCloud cloud = rosCloud({ahead}, 0, robot, {}, stamp_ns);
  ASSERT_EQ(cloud.points.size(), 1U);
  EXPECT_EQ(cloud.frame, "map");
  EXPECT_NEAR((cloud.points[0] - Eigen::Vector3f(2.2F, 0, 0.4F)).norm(), 0, 1e-6)
      << "2 m before the camera, which sits 0.2 m ahead and 0.4 m above the body's origin";
}

}  // namespace
}  // namespace edgeslam
