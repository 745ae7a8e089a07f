#include "drivers/lcm/messages.h"

#include <gtest/gtest.h>

#include <bot_core/pose_t.hpp>
#include <cmath>
#include <fovis/update_t.hpp>
#include <limits>
#include <vector>

#include "unit/lcm/encoded_message.h"
#include "unit/lcm/made_frames.h"

namespace edgeslam {
namespace {

constexpr std::size_t packet_bytes = 1400;

template <class To, class From>
To decodedAs(const From& message) {
  const std::vector<std::uint8_t> bytes = encoded(message);
  To decoded;
  EXPECT_EQ(decoded.decode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
  return decoded;
}

LcmFrame messagesOf(const FrameResult& now, const RobotSetup& robot = {},
                    const std::optional<FrameResult>& before = {}) {
  return frameMessages(now, robot, before ? measuredPose(*before) : std::nullopt, 7, 1234);
}

void expectFinite(const LcmFrame& messages) {
  for (const auto* values : {&messages.state.position, &messages.state.camera_position, &messages.state.velocity,
                             &messages.state.rotation_rate, &messages.update.translation}) {
    for (const double value : *values) EXPECT_TRUE(std::isfinite(value));
  }
  for (const auto* quaternion :
       {&messages.state.orientation, &messages.state.camera_orientation, &messages.update.rotation}) {
    double squares = 0;
    for (const double value : *quaternion) squares += value * value;
    EXPECT_NEAR(squares, 1, 1e-9);
  }
  for (const auto* covariance : {&messages.state.covariance, &messages.update.covariance}) {
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) EXPECT_TRUE(std::isfinite((*covariance)[i][j]));
      EXPECT_GT((*covariance)[i][i], 0) << "no certainty";
    }
  }
  EXPECT_TRUE(std::isfinite(messages.state.latency_ms));
}

TEST(Messages, PoseIsReadByThePublishedType) {
  Random random(1);
  const FrameResult before = measuredFrame(0, randomPose(random));
  const FrameResult now = measuredFrame(1, before.world_T_camera * Pose{rotationExp({0, 0.01, 0}), {0.02, 0, 0.01}});
  const LcmFrame messages = messagesOf(now, metricRobot(randomPose(random), 0.5), before);
  ASSERT_TRUE(messages.pose);
  EXPECT_EQ(pose_t::getHash(), bot_core::pose_t::getHash());
  const auto decoded = decodedAs<bot_core::pose_t>(*messages.pose);
  EXPECT_EQ(decoded.utime, now.time_ns / 1000);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(decoded.pos[i], messages.state.position[i]);
    EXPECT_EQ(decoded.vel[i], messages.state.velocity[i]);
    EXPECT_NE(decoded.vel[i], 0);
    EXPECT_EQ(decoded.rotation_rate[i], messages.state.rotation_rate[i]);
    EXPECT_EQ(decoded.accel[i], 0);
  }
  for (int i = 0; i < 4; ++i) EXPECT_EQ(decoded.orientation[i], messages.state.orientation[i]);
}

// The hash that programs in the field compare with: of the published type, rotated as LCM does.
TEST(Messages, PoseHasThePublishedHash) {
  const std::uint64_t base = 0x170b77d82958082fULL;
  EXPECT_EQ(static_cast<std::uint64_t>(pose_t::getHash()), (base << 1) + (base >> 63));
}

TEST(Messages, UpdateIsReadByThePublishedType) {
  Random random(2);
  const FrameResult before = measuredFrame(0, randomPose(random));
  const Pose step{rotationExp({0, 0.01, 0}), {0.02, 0, 0.01}};
  const FrameResult now = measuredFrame(1, before.world_T_camera * step);
  const LcmFrame messages = messagesOf(now, {}, before);
  EXPECT_EQ(update_t::getHash(), fovis::update_t::getHash());
  const auto decoded = decodedAs<fovis::update_t>(messages.update);
  EXPECT_EQ(decoded.timestamp, now.time_ns / 1000);
  EXPECT_EQ(decoded.prev_timestamp, before.time_ns / 1000);
  EXPECT_EQ(decoded.estimate_status, update_t::ESTIMATE_VALID);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(decoded.translation[i], step.translation[i], 1e-12);
  EXPECT_NEAR(decoded.rotation[0], step.rotation.w(), 1e-12);
  EXPECT_NEAR(decoded.rotation[2], step.rotation.y(), 1e-12);
}

TEST(Messages, TwistIsOfTheBodyInItsOwnFrame) {
  Random random(3);
  for (int i = 0; i < 30; ++i) {
    // The camera sits anywhere on the body; the velocity is told in the later body's frame.
    const RobotSetup robot = metricRobot(randomPose(random), random.uniform(0.2, 3));
    const Eigen::Vector3d velocity = random.vector(1), rate = random.vector(10);
    const double dt = 1e-9 * static_cast<double>(frame_interval_ns);
    const Pose body_T_camera = robot.body_T_camera;
    const auto cameraAt = [&](const Pose& local_T_body) {
      Pose pose = body_T_camera.inverse() * local_T_body * body_T_camera;
      pose.translation /= robot.scale.metres_per_unit;
      return pose;
    };
    const Pose first = randomPose(random);
    const Eigen::Quaterniond turn = rotationExp(rate * dt);
    const Pose second = first * Pose{turn, turn * (velocity * dt)};
    const LcmFrame messages = messagesOf(measuredFrame(1, cameraAt(second)), robot, measuredFrame(0, cameraAt(first)));
    ASSERT_TRUE(messages.state.has_twist);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(messages.state.rotation_rate[k], rate[k], 1e-6);
      EXPECT_NEAR(messages.state.velocity[k], velocity[k], 1e-9);
    }
  }
}

TEST(Messages, TheWorldIsToldAndNoMotionLeadsFromOneToAnother) {
  Random random(9);
  FrameResult before = measuredFrame(0, randomPose(random)), now = measuredFrame(1, randomPose(random));
  before.reference = now.reference = 3;  // joined since: the keyframe's unit was another before
  EXPECT_EQ(messagesOf(now).state.world, 0) << "of a frame that does not tell it";
  before.world = 2, now.world = 1;
  const LcmFrame messages = messagesOf(now, {}, before);
  EXPECT_EQ(messages.state.world, 1);
  EXPECT_FALSE(messages.state.has_twist);
  EXPECT_EQ(messages.update.estimate_status, update_t::NO_DATA);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(messages.pose->vel[i], 0);
  before.world = 1;
  EXPECT_TRUE(messagesOf(now, {}, before).state.has_twist);
  EXPECT_EQ(messagesOf(frameWithoutPose(2, TrackingState::lost, "dark")).state.world, -1);
  now.world_T_camera.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(messagesOf(now).state.world, -1);
}

TEST(Messages, AStateTellsBodyAndCameraWithPositiveW) {
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    FrameResult frame = measuredFrame(6, randomPose(random));
    if (i % 2) frame.world_T_camera.rotation.coeffs() *= -1;  // the same rotation
    const RobotSetup robot = metricRobot(randomPose(random), 0.5);
    const state_t state = messagesOf(frame, robot).state;
    const Pose body = bodyPose(frame.world_T_camera, robot);
    EXPECT_LT(rotationAngle({state.orientation[0], state.orientation[1], state.orientation[2], state.orientation[3]},
                            body.rotation),
              1e-7);
    EXPECT_LT(rotationAngle({state.camera_orientation[0], state.camera_orientation[1], state.camera_orientation[2],
                             state.camera_orientation[3]},
                            frame.world_T_camera.rotation),
              1e-7);
    EXPECT_GE(state.orientation[0], 0);
    EXPECT_GE(state.camera_orientation[0], 0);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(state.position[k], body.translation[k], 1e-12);
      EXPECT_NEAR(state.camera_position[k], 0.5 * frame.world_T_camera.translation[k], 1e-12);
    }
    const Matrix6d covariance = bodyCovariance(frame.world_covariance, robot);
    EXPECT_EQ(state.covariance[1][4], covariance(1, 4));
    EXPECT_EQ(state.sequence, 7);
    EXPECT_EQ(state.frame, 6);
    EXPECT_EQ(state.publish_utime, 1234);
    EXPECT_EQ(state.points_tracked, 400);
    EXPECT_EQ(state.points_mapped, 200);
    EXPECT_EQ(state.latency_ms, 12);
  }
}

TEST(Messages, AFrameWithoutAPoseSendsNoneAndSaysWhy) {
  for (const TrackingState state : {TrackingState::initialising, TrackingState::lost}) {
    const LcmFrame messages = messagesOf(frameWithoutPose(1, state, "too few points"), {}, measuredFrame(0, Pose()));
    EXPECT_FALSE(messages.pose);
    EXPECT_FALSE(messages.state.has_pose);
    EXPECT_FALSE(messages.state.has_twist);
    EXPECT_EQ(messages.state.reason, "too few points");
    EXPECT_EQ(messages.state.state, stateNumber(state));
    EXPECT_EQ(messages.update.estimate_status,
              state == TrackingState::lost ? update_t::ESTIMATE_INSUFFICIENT_FEATURES : update_t::NO_DATA);
    EXPECT_EQ(messages.update.timestamp, messages.update.prev_timestamp);
    EXPECT_EQ(messages.state.covariance[0][0], unknown_variance);
    expectFinite(messages);
  }
}

TEST(Messages, AGuessedPoseIsToldButNotPublishedAsMeasured) {
  FrameResult frame = measuredFrame(1, Pose());
  frame.state = TrackingState::predicted;
  const LcmFrame messages = messagesOf(frame, {}, measuredFrame(0, Pose()));
  EXPECT_FALSE(messages.pose);
  EXPECT_TRUE(messages.state.has_pose);
  EXPECT_EQ(messages.state.state, state_t::PREDICTED);
  EXPECT_EQ(messages.update.estimate_status, update_t::ESTIMATE_INSUFFICIENT_FEATURES);
}

TEST(Messages, TheFirstPoseAfterALongLossHasNoMotion) {
  const LcmFrame messages = messagesOf(measuredFrame(100, Pose()), {}, measuredFrame(0, Pose()));
  EXPECT_TRUE(messages.pose);
  EXPECT_FALSE(messages.state.has_twist);
  EXPECT_EQ(messages.update.estimate_status, update_t::NO_DATA);
}

TEST(Messages, WhatIsNotFiniteNeverGoesOut) {
  const double broken_values[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
  for (const double broken : broken_values) {
    FrameResult pose = measuredFrame(1, Pose());
    pose.world_T_camera.translation.y() = broken;
    const LcmFrame lost = messagesOf(pose, {}, measuredFrame(0, Pose()));
    expectFinite(lost);
    EXPECT_FALSE(lost.pose);
    EXPECT_EQ(lost.state.state, state_t::LOST);
    EXPECT_EQ(lost.state.reason, "the pose is not finite");

    FrameResult rest = measuredFrame(1, Pose());
    rest.world_covariance(4, 4) = rest.latency_ms = rest.reference_T_camera.translation.x() = broken;
    rest.reference = 1;
    const LcmFrame kept = messagesOf(rest, {}, measuredFrame(0, Pose()));
    expectFinite(kept);
    EXPECT_TRUE(kept.pose);
    EXPECT_EQ(kept.state.covariance[0][0], unknown_variance);
    EXPECT_EQ(kept.state.latency_ms, -1);
  }
}

TEST(Messages, TheScaleIsTold) {
  const Pose at{Eigen::Quaterniond::Identity(), {2, 0, 0}};
  const LcmFrame unknown = messagesOf(measuredFrame(0, at));
  EXPECT_EQ(unknown.state.scale_state, state_t::SCALE_UNKNOWN);
  EXPECT_EQ(unknown.state.scale, 1);
  EXPECT_EQ(unknown.state.position[0], 2);
  const LcmFrame metric = messagesOf(measuredFrame(0, at), metricRobot(Pose(), 0.25));
  EXPECT_EQ(metric.state.scale_state, state_t::SCALE_FROM_KNOWN_DISTANCE);
  EXPECT_EQ(metric.state.scale, 0.25);
  EXPECT_EQ(metric.state.scale_sigma, 0.02);
  EXPECT_EQ(metric.state.position[0], 0.5);
  EXPECT_EQ(metric.state.camera_position[0], 0.5);
}

TEST(Messages, FitIntoAPacketWithTheLongestReason) {
  FrameResult frame = measuredFrame(1, Pose());
  frame.reason = std::string(5000, 'x');
  const LcmFrame messages = messagesOf(frame);
  EXPECT_LT(encoded(messages.state).size(), packet_bytes);
  EXPECT_LT(encoded(messages.update).size(), packet_bytes);
  EXPECT_LT(encoded(*messages.pose).size(), packet_bytes);
  EXPECT_EQ(decodedAs<state_t>(messages.state).reason.size(), 200U);
}

TEST(Messages, TextIsPlainAscii) {
  EXPECT_EQ(messageText("frame 3: ok"), "frame 3: ok");
  EXPECT_EQ(messageText(std::string("a\n\0\xc3\xa4", 5)), "a????");
}

TEST(Messages, MicrosecondsAreRoundedDown) {
  EXPECT_EQ(utimeOf(1999), 1);
  EXPECT_EQ(utimeOf(2000), 2);
  EXPECT_EQ(utimeOf(-1), -1);
  EXPECT_EQ(utimeOf(-1000), -1);
}

}  // namespace
}  // namespace edgeslam
