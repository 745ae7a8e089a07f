// Rolling shutter: every row has a pose of its own.
#include "geometry/rolling_shutter.h"

#include <gtest/gtest.h>

#include <random>

namespace edgeslam {
namespace {

Camera rollingCamera(double readout_s) {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 500;
  camera.cx = 320;
  camera.cy = 240;
  camera.readout_s = readout_s;
  return camera;
}

class RollingShutterTest : public testing::Test {
 protected:
  double number(double size) { return std::uniform_real_distribution<double>(-size, size)(random_); }
  Eigen::Vector3d vector(double size) { return {number(size), number(size), number(size)}; }
  Pose pose() { return {rotationExp(vector(1)), vector(2)}; }
  Twist twist(double speed, double turn) {
    Twist twist;
    twist << vector(speed), vector(turn);
    return twist;
  }

  std::mt19937 random_{1};
};

TEST_F(RollingShutterTest, RowsAreReadFromAboveOrFromBelow) {
  EXPECT_DOUBLE_EQ(rowTime(rollingCamera(0.02), 0), -0.01);
  EXPECT_DOUBLE_EQ(rowTime(rollingCamera(0.02), 479), 0.01);
  EXPECT_DOUBLE_EQ(rowTime(rollingCamera(-0.02), 0), 0.01);
  EXPECT_DOUBLE_EQ(rowTime(rollingCamera(0.02), 239.5), 0);
  EXPECT_DOUBLE_EQ(rowTime(rollingCamera(0), 100), 0);
}

TEST_F(RollingShutterTest, APointIsSeenInTheRowThatReadsIt) {
  const Camera camera = rollingCamera(0.024);
  for (int run = 0; run < 200; ++run) {
    const Twist moving = twist(0.5, 1);
    const Eigen::Vector3d point(number(0.8), number(0.6), 2);
    const Eigen::Vector2d pixel = projectToRow(camera, moving, point);
    if (!insideImage(camera, pixel)) continue;
    const Eigen::Vector3d seen = rowPose(camera, moving, pixel.y()).inverse() * point;
    EXPECT_LT((project(camera, seen) - pixel).norm(), 0.02);
    const Ray ray = rayOfRow(camera, moving, pixel.y(), bearing(camera, pixel));
    EXPECT_LT((ray.origin + ray.direction * (point - ray.origin).norm() - point).norm(), 1e-3);
  }
}

TEST_F(RollingShutterTest, AGlobalShutterSeesWhatItSawBeforeToTheLastBit) {
  const Camera camera = rollingCamera(0);
  for (int run = 0; run < 50; ++run) {
    const Eigen::Vector3d point(number(0.8), number(0.6), 2);
    EXPECT_EQ(projectToRow(camera, twist(1, 1), point), project(camera, point));
    const Pose at = pose();
    const Pose in_row = worldTRow(camera, {at, twist(1, 1)}, 17);
    EXPECT_EQ(in_row.translation, at.translation);
    EXPECT_EQ(in_row.rotation.coeffs(), at.rotation.coeffs());
  }
}

TEST_F(RollingShutterTest, TwistOfASteadyTurnIsItsRate) {
  const Pose before = pose();
  const Twist steady = twist(0, 2);
  const Pose now = before * movedFor(steady, 0.05);
  EXPECT_LT((twistBetween(before, now, 0.05) - steady).norm(), 1e-12);
  RowMotion motion;
  motion.world_T_before = before;
  motion.seconds = 0.05;
  motion.before = steady;
  motion.is_known_from_before = true;
  EXPECT_LT((twistOf(motion, now) - steady).norm(), 1e-12);
  // What changes goes on changing for half an interval.
  motion.before = 0.8 * steady;
  EXPECT_LT((twistOf(motion, now) - 1.1 * steady).norm(), 1e-12);
  motion.seconds = 0;
  EXPECT_EQ(twistOf(motion, now), motion.before);
}

TEST_F(RollingShutterTest, DerivativesMatchDifferences) {
  constexpr double step = 1e-6;
  for (int run = 0; run < 50; ++run) {
    RowMotion motion;
    motion.world_T_before = pose();
    motion.seconds = 0.04;
    motion.before = twist(1, 2);
    motion.is_known_from_before = run % 2 == 0;
    const Pose now = motion.world_T_before * movedFor(twist(2, 6), motion.seconds);
    Matrix6d analytic, numeric;
    twistOf(motion, now, &analytic);
    for (int k = 0; k < 6; ++k) {
      const Vector6d update = step * Vector6d::Unit(k);
      numeric.col(k) = (twistOf(motion, retract(now, update)) - twistOf(motion, retract(now, -update))) / (2 * step);
    }
    EXPECT_LT((analytic - numeric).norm(), 1e-6 * analytic.norm());

    const Eigen::Vector3d turn = vector(run % 3 == 0 ? 1e-5 : 1.5);
    Eigen::Matrix3d by_turn;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d change = step * Eigen::Vector3d::Unit(k);
      const auto from = [&](const Eigen::Vector3d& to) {
        return rotationLog((rotationExp(turn).conjugate() * rotationExp(to)).normalized());
      };
      by_turn.col(k) = (from(turn + change) - from(turn - change)) / (2 * step);
    }
    EXPECT_LT((rightJacobian(turn) - by_turn).norm(), 1e-6);
  }
}

TEST_F(RollingShutterTest, TheSeriesOfASmallTurnGoesOnAsTheSinesOfALargeOne) {
  const Eigen::Vector3d axis = vector(1).normalized();
  const double angle = std::sqrt(most_squared_for_series);
  const Eigen::Matrix3d below = rightJacobian((1 - 1e-12) * angle * axis);
  const Eigen::Matrix3d above = rightJacobian((1 + 1e-12) * angle * axis);
  EXPECT_LT((above - below).norm(), 1e-12);
}

}  // namespace
}  // namespace edgeslam
