// An odometry frame goes on by motion alone: through corrections of the map, frames that were predicted and positions
// that were held; and it tells where the motion is not known.
#include "visual_odometry/odometry_frame.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>

#include "moving_camera.h"

namespace edgeslam::test {
namespace {

const Pose step{rotationExp({0.01, -0.02, 0.005}), {0.02, 0.001, 0.01}};
constexpr int frames_a_second = 30;

Pose times(int count) {
  Pose all;
  for (int i = 0; i < count; ++i) all = all * step;
  return all;
}

void expectSame(const Pose& a, const Pose& b, double tolerance = 1e-9) {
  EXPECT_LT((a.translation - b.translation).norm(), tolerance);
  EXPECT_LT(rotationAngle(a.rotation, b.rotation), 1e-7);
}

// Of several frames; the last one's must be there.
template <class Next>
OdometryFrame after(int frames, CameraOdometry& odometry, const Next& next) {
  std::optional<OdometryFrame> latest;
  for (int i = 0; i < frames; ++i) latest = odometry.next(next());
  EXPECT_TRUE(latest.has_value());
  return latest.value_or(OdometryFrame());
}

TEST(OdometryFrame, BeginsAtTheFirstMeasuredPoseAndFollowsTheMotion) {
  MovingCamera camera(step);
  CameraOdometry odometry;
  FrameResult waiting;
  waiting.reason = "motion of the camera";
  EXPECT_FALSE(odometry.next(waiting));
  expectSame(after(1, odometry, [&] { return camera.tracked(); }).odom_T_camera, Pose());
  expectSame(after(50, odometry, [&] { return camera.tracked(); }).odom_T_camera, times(50));
}

TEST(OdometryFrame, DoesNotShowCorrectionsOfTheMap) {
  MovingCamera camera(step);
  CameraOdometry odometry;
  after(20, odometry, [&] { return camera.tracked(); });
  camera.correctMap({rotationExp({0.1, 0, 0.2}), {3, -1, 2}});
  const OdometryFrame end = after(20, odometry, [&] { return camera.tracked(); });
  expectSame(end.odom_T_camera, times(39));
  EXPECT_EQ(end.resets, 0);
}

TEST(OdometryFrame, ItsDriftNeverShrinks) {
  MovingCamera camera(step);
  CameraOdometry odometry;
  double before = 0;
  for (int i = 0; i < 100; ++i) {
    const OdometryFrame frame = after(1, odometry, [&] { return i % 7 == 3 ? camera.predicted() : camera.tracked(); });
    const double drift = frame.drift.trace();
    EXPECT_GE(drift, before * (1 - 1e-12));
    EXPECT_GT(frame.covariance.trace(), drift) << "the pose now is not certain either";
    EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix6d>(frame.covariance).eigenvalues().minCoeff(), -1e-15);
    before = drift;
  }
}

TEST(OdometryFrame, ItsDriftIsWhatTheWorldsCovarianceGrewBy) {
  MovingCamera camera(step);
  CameraOdometry odometry;
  FrameResult latest;
  const auto track = [&] { return latest = camera.tracked(); };
  after(1, odometry, track);
  const Matrix6d at_start = latest.world_covariance;
  const OdometryFrame end = after(200, odometry, track);
  const Matrix6d grown = latest.world_covariance - at_start;
  EXPECT_GT(end.drift(5, 5), 0.9 * grown(5, 5));
  EXPECT_LT(end.drift(5, 5), 1.5 * (grown(5, 5) + latest.covariance(5, 5)));
}

TEST(OdometryFrame, GoesOnFromPredictionOverAShortGapAndDoesNotJumpBack) {
  MovingCamera camera(step);
  CameraOdometry odometry;
  after(10, odometry, [&] { return camera.tracked(); });
  const Eigen::Vector3d off(0.03, 0, 0);
  const OdometryFrame gap = after(5, odometry, [&] { return camera.predicted(off); });
  EXPECT_LT((gap.odom_T_camera.translation - times(14).translation).norm(), 0.031);
  Pose before = gap.odom_T_camera;
  for (int i = 0; i < frames_a_second / 2 + 1; ++i) {
    const OdometryFrame back = after(1, odometry, [&] { return camera.tracked(); });
    EXPECT_EQ(back.resets, 0);
    expectSame(before.inverse() * back.odom_T_camera, step, 0.004);  // a share of the 30 mm that were wrong
    before = back.odom_T_camera;
  }
  expectSame(before, times(14 + frames_a_second / 2 + 1), 1e-6);  // in the end nothing of it is left
}

TEST(OdometryFrame, TakesBackWhatTwoGapsLeft) {
  MovingCamera camera(step);
  CameraOdometry odometry;
  after(10, odometry, [&] { return camera.tracked(); });
  after(3, odometry, [&] { return camera.predicted({0.03, 0, 0}); });
  after(4, odometry, [&] { return camera.tracked(); });
  after(3, odometry, [&] { return camera.lost(); });
  after(1, odometry, [&] { return camera.predicted({0, -0.02, 0.01}); });
  expectSame(after(20, odometry, [&] { return camera.tracked(); }).odom_T_camera, times(40), 1e-6);
}

TEST(OdometryFrame, KeepsAnErrorThatACorrectedMapDoesNotTell) {
  MovingCamera camera(step);
  CameraOdometry odometry;
  const double before = after(10, odometry, [&] { return camera.tracked(); }).drift.trace();
  after(5, odometry, [&] { return camera.predicted({0.03, 0, 0}); });
  camera.correctMap({rotationExp({0.1, 0, 0.2}), {3, -1, 2}});
  const OdometryFrame back = after(30, odometry, [&] { return camera.tracked(); });
  EXPECT_LT((back.odom_T_camera.translation - times(44).translation).norm(), 0.05);
  EXPECT_GT(back.drift.trace(), before + 5e-4) << "and says so";
}

TEST(OdometryFrame, BridgesLostFramesForASecondOnly) {
  MovingCamera camera(step);
  CameraOdometry odometry;
  after(10, odometry, [&] { return camera.tracked(); });
  const OdometryFrame last = after(frames_a_second, odometry, [&] { return camera.lost(); });
  EXPECT_FALSE(odometry.next(camera.lost()));
  const OdometryFrame back = after(1, odometry, [&] { return camera.tracked(); });
  EXPECT_EQ(back.resets, 1);
  expectSame(back.odom_T_camera, last.odom_T_camera);
  expectSame(after(5, odometry, [&] { return camera.tracked(); }).odom_T_camera, last.odom_T_camera * times(5));
}

TEST(OdometryFrame, TellsWhereTheMotionIsNotKnown) {
  MovingCamera camera(step);
  CameraOdometry odometry;
  after(10, odometry, [&] { return camera.tracked(); });
  camera.enterWorld(1);
  EXPECT_EQ(after(3, odometry, [&] { return camera.tracked(); }).resets, 1) << "another world";
  odometry.next(FrameResult());
  EXPECT_EQ(after(3, odometry, [&] { return camera.tracked(); }).resets, 2) << "another map";
  camera.forgetLocated();
  EXPECT_EQ(after(3, odometry, [&] { return camera.tracked(); }).resets, 3) << "no frame before";
}

TEST(OdometryFrame, StaysWhereThePositionIsHeld) {
  MovingCamera camera(step);
  CameraOdometry odometry;
  const OdometryFrame before = after(10, odometry, [&] { return camera.tracked(); });
  const OdometryFrame held = after(3 * frames_a_second, odometry, [&] { return camera.held(); });
  EXPECT_LT((held.odom_T_camera.translation - before.odom_T_camera.translation).norm(), 1e-12);
  const Eigen::Quaterniond turned = before.odom_T_camera.rotation.conjugate() * held.odom_T_camera.rotation;
  EXPECT_LT(rotationAngle(turned, times(3 * frames_a_second).rotation), 1e-6);
  OdometryFrame back = after(1, odometry, [&] { return camera.tracked(); });
  const double all = times(3 * frames_a_second + 1).translation.norm();
  EXPECT_LT((back.odom_T_camera.translation - held.odom_T_camera.translation).norm(), 0.1 * all);
  EXPECT_EQ(back.resets, 0);
  back = after(frames_a_second, odometry, [&] { return camera.tracked(); });
  expectSame(back.odom_T_camera, times(9 + 4 * frames_a_second + 1), 1e-6);  // where the map says that it went
}

TEST(OdometryFrame, TakesNothingThatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  MovingCamera camera(step);
  CameraOdometry odometry;
  after(10, odometry, [&] { return camera.tracked(); });
  for (int kind = 0; kind < 4; ++kind) {
    FrameResult broken = camera.tracked();
    if (kind == 0) broken.previous_T_camera.translation.x() = nan;
    if (kind == 1) broken.previous_T_camera.rotation.coeffs().setConstant(nan);
    if (kind == 2) broken.world_T_camera.translation.y() = nan;
    if (kind == 3) broken.covariance(2, 3) = nan;
    if (const auto frame = odometry.next(broken)) {
      EXPECT_TRUE(frame->odom_T_camera.translation.allFinite());
      EXPECT_TRUE(frame->covariance.allFinite());
    }
    const OdometryFrame next = after(1, odometry, [&] { return camera.tracked(); });
    EXPECT_TRUE(next.odom_T_camera.translation.allFinite());
    EXPECT_TRUE(next.odom_T_camera.rotation.coeffs().allFinite());
    EXPECT_TRUE(next.covariance.allFinite());
  }
}

}  // namespace
}  // namespace edgeslam::test
