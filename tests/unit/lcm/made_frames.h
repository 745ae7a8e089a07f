// Frames of a camera that moves at a constant twist.
#pragma once

#include <gtest/gtest.h>

#include "drivers/lcm/body_pose.h"
#include "unit/geometry/scene_fixture.h"

namespace edgeslam {

constexpr std::int64_t frame_interval_ns = 33333333;

inline FrameResult measuredFrame(std::int64_t index, const Pose& world_T_camera) {
  FrameResult frame;
  frame.index = index;
  frame.time_ns = 5000000000 + index * frame_interval_ns;
  frame.state = TrackingState::tracking;
  frame.has_pose = true;
  frame.world_T_camera = world_T_camera;
  frame.covariance = 1e-6 * Matrix6d::Identity();
  frame.world_covariance = 4e-6 * Matrix6d::Identity();
  frame.tracked_points = 400;
  frame.mapped_points = 200;
  frame.latency_ms = 12;
  return frame;
}

inline FrameResult frameWithoutPose(std::int64_t index, TrackingState state, const std::string& reason) {
  FrameResult frame = measuredFrame(index, Pose());
  frame.state = state;
  frame.reason = reason;
  frame.has_pose = false;
  frame.covariance.setZero();
  frame.world_covariance.setZero();
  return frame;
}

inline void expectSame(const Pose& a, const Pose& b, double tolerance_m = 1e-9) {
  EXPECT_LT(rotationAngle(a.rotation, b.rotation), 1e-7);
  EXPECT_LT((a.translation - b.translation).norm(), tolerance_m);
}

inline Pose randomPose(Random& random) { return {random.rotation(random.uniform(0, 3.1)), random.vector(3)}; }

// Of full rank.
inline Matrix6d randomCovariance(Random& random) {
  Matrix6d root;
  for (int i = 0; i < 36; ++i) root(i) = random.uniform(-0.01, 0.01);
  return root * root.transpose() + 1e-8 * Matrix6d::Identity();
}

inline RobotSetup metricRobot(const Pose& body_T_camera, double metres_per_unit) {
  return {body_T_camera, {ScaleKind::known_distance, metres_per_unit, 0.02}};
}

}  // namespace edgeslam
