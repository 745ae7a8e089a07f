#include "scale/scale_from_distance.h"

#include <gtest/gtest.h>

#include "unit/lcm/made_frames.h"
#include "wheels/utime.h"

namespace edgeslam {
namespace {

std::int64_t utimeOfFrame(int index) { return utimeOf(measuredFrame(index, Pose()).time_ns); }

FrameResult frameAt(int index, const Eigen::Vector3d& position) {
  return measuredFrame(index, {Eigen::Quaterniond::Identity(), position});
}

// A walk along x, 0.1 map units a frame.
PositionHistory walked(int frames, std::size_t capacity = 1000) {
  PositionHistory history(capacity);
  for (int i = 0; i < frames; ++i) history.add(frameAt(i, {0.1 * i, 0, 0}));
  return history;
}

ScaleResult scaleOver(const PositionHistory& history, int from, int to, double distance_m) {
  return scaleFromDistance(history, utimeOfFrame(from), utimeOfFrame(to), distance_m, {});
}

TEST(ScaleFromDistance, IsMetresOverMapUnitsEitherWayRound) {
  const PositionHistory history = walked(50);
  for (const auto& [from, to] : {std::pair(5, 45), std::pair(45, 5)}) {
    const ScaleResult result = scaleOver(history, from, to, 2.0);
    ASSERT_TRUE(result.problem.empty()) << result.problem;
    EXPECT_EQ(result.scale.kind, ScaleKind::known_distance);
    EXPECT_NEAR(result.scale.metres_per_unit, 0.5, 1e-12);
    // Each position is known to 1e-3 along the way of 4.
    EXPECT_NEAR(result.scale.sigma, std::sqrt(2e-6) / 4, 1e-9);
  }
}

TEST(ScaleFromDistance, FramesInTwoWorldsAreRefused) {
  PositionHistory history;
  for (int i = 0; i < 40; ++i) {
    FrameResult frame = frameAt(i, {0.1 * i, 0, 0});
    frame.world = i < 20 ? 0 : 3;
    history.add(frame);
  }
  EXPECT_EQ(scaleOver(history, 5, 35, 2.0).problem, "the two frames are in maps that were not joined");
  EXPECT_EQ(scaleOver(history, 5, 15, 2.0).world, 0);
  EXPECT_EQ(scaleOver(history, 35, 25, 2.0).world, 3);
  EXPECT_EQ(scaleOver(history, 35, 25, 2.0).problem, "");
}

TEST(ScaleFromDistance, OnlyTheUncertaintyAlongTheWayCounts) {
  Random random(3);
  const Pose turned = {random.rotation(1.2), {0, 0, 0}};
  // Uncertain along the camera's z only; the way is along the world's axis that z is turned to, or square to it.
  const Eigen::Vector3d along = turned.rotation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d across = turned.rotation * Eigen::Vector3d::UnitX();
  for (const auto& [way, sigma] : {std::pair(along, 0.03), std::pair(across, 0.001)}) {
    PositionHistory history;
    for (int i = 0; i < 2; ++i) {
      FrameResult frame = measuredFrame(i, {turned.rotation, i * way});
      frame.covariance(2, 2) = 9e-4;
      history.add(frame);
    }
    const ScaleResult result = scaleOver(history, 0, 1, 1.0);
    EXPECT_NEAR(result.scale.sigma, std::sqrt(2.0) * sigma, 1e-6);
  }
}

TEST(ScaleFromDistance, FramesTooNearTogetherAreRefused) {
  PositionHistory history;
  history.add(frameAt(0, {0, 0, 0}));
  history.add(frameAt(1, {0.005, 0, 0}));
  history.add(frameAt(2, {0.005, 0, 0}));
  EXPECT_NE(scaleOver(history, 0, 1, 1).problem.find("too near together"), std::string::npos);
  EXPECT_NE(scaleOver(history, 1, 2, 1).problem.find("did not move"), std::string::npos);
  EXPECT_NE(scaleOver(history, 1, 1, 1).problem.find("did not move"), std::string::npos);
}

TEST(ScaleFromDistance, FramesWithoutAMeasuredPoseAreNamed) {
  PositionHistory history = walked(20);
  FrameResult lost = frameWithoutPose(20, TrackingState::lost, "dark");
  history.add(lost);
  EXPECT_EQ(scaleOver(history, 3, 20, 1).problem.rfind("to_utime ", 0), 0U);
  EXPECT_EQ(scaleOver(history, 20, 3, 1).problem.rfind("from_utime ", 0), 0U);
  FrameResult unsure = frameAt(21, {9, 0, 0});
  unsure.covariance.setConstant(std::numeric_limits<double>::quiet_NaN());
  history.add(unsure);
  EXPECT_FALSE(scaleOver(history, 3, 21, 1).problem.empty());
  history.clear();
  EXPECT_FALSE(scaleOver(history, 3, 10, 1).problem.empty());
}

TEST(ScaleFromDistance, TheHistoryKeepsTheLatest) {
  const PositionHistory history = walked(250, 100);
  EXPECT_EQ(history.find(utimeOfFrame(149)), nullptr);
  for (int i = 150; i < 250; ++i) {
    ASSERT_NE(history.find(utimeOfFrame(i)), nullptr) << i;
    EXPECT_NEAR(history.find(utimeOfFrame(i))->position.x(), 0.1 * i, 1e-12);
  }
}

}  // namespace
}  // namespace edgeslam
