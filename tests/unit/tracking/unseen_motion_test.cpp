// Where the camera is while the map does not tell it, by wheels and an inertial unit together.
#include "tracking/unseen_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/tracking/circling_robot.h"

namespace edgeslam {
namespace {

constexpr double turn_rad_s = 0.4;

// Where the robot is, or what its wheels tell that turn `turns` times as much.
Pose fastCircle(double time_s, double turns = 1) { return onCircle(turns * turn_rad_s * time_s); }

class UnseenMotionOfRobot : public testing::Test {
 protected:
  UnseenMotionOfRobot() {
    unit_.imu_T_camera = robot_T_camera;  // it sits where the body's origin is
    view_.inertia.emplace();
    view_.inertia->rate_bias_sigma = 1e-4;
    view_.wheels = {true, robot_metres_a_unit, 0.02};
  }

  // The camera is located in frames until the time; the wheels turn by so many times as much as the robot.
  UnseenMotion driven(bool with_unit, double until_s, double wheel_turns) {
    UnseenMotion motion(with_unit ? std::optional(unit_) : std::nullopt, {}, WheelOptions{robot_T_camera, false}, {});
    FollowedFrame before;
    for (double time_s = 0; time_s < until_s + 3; time_s += 0.005) {
      InertialSample sample;
      sample.time_ns = nanoseconds(time_s);
      sample.rate.z() = turn_rad_s;
      motion.add(sample);
    }
    for (double time_s = 0; time_s < until_s + 3; time_s += 0.02) {
      const double blind_s = std::max(0.0, time_s - until_s);
      const Pose body = fastCircle(std::min(time_s, until_s)) * fastCircle(blind_s, wheel_turns);
      motion.add({nanoseconds(time_s) / 1000, body});
    }
    for (double time_s = 0; time_s < until_s + 1e-9; time_s += robot_frame_s) {
      last_ = frameAt(time_s);
      last_.wheels = motion.wheelsAt(nanoseconds(time_s));
      if (before.isThere()) motion.observe(before, last_, 1e-3, view_);
      before = last_;
    }
    return motion;
  }
  static FollowedFrame frameAt(double time_s) {
    FollowedFrame frame;
    auto images = std::make_shared<FrameImages>();
    images->time_ns = nanoseconds(time_s);
    frame.images = images;
    const Pose camera = fastCircle(time_s) * robot_T_camera;
    frame.world_T_camera = {camera.rotation, camera.translation / robot_metres_a_unit};
    frame.covariance.diagonal() << 1e-6, 1e-6, 1e-6, 1e-7, 1e-7, 1e-7;
    return frame;
  }
  static double turnError(const Pose& pose, double time_s) {
    return rotationAngle(pose.rotation, frameAt(time_s).world_T_camera.rotation);
  }
  static double placeError(const Pose& pose, double time_s) {
    return (pose.translation - frameAt(time_s).world_T_camera.translation).norm();
  }

  InertialUnit unit_;
  MapView view_;
  FollowedFrame last_;
};

TEST_F(UnseenMotionOfRobot, IsTurnedAsTheGyroscopeSaysAndWhereTheWheelsSay) {
  const UnseenMotion with = driven(true, 2, 0.95), without = driven(false, 2, 0.95);
  for (const double time_s : {2.1, 3.0, 4.5}) {
    const auto both = with.carriedByWheels(last_, {}, nanoseconds(time_s), view_);
    const auto alone = without.carriedByWheels(last_, {}, nanoseconds(time_s), view_);
    ASSERT_TRUE(both && alone) << time_s;
    EXPECT_LT(turnError(both->world_T_camera, time_s), 1e-3);
    EXPECT_GT(turnError(alone->world_T_camera, time_s), turnError(both->world_T_camera, time_s));
    EXPECT_LT(placeError(both->world_T_camera, time_s), placeError(alone->world_T_camera, time_s));
    EXPECT_LT(both->covariance(4, 4), alone->covariance(4, 4));
    EXPECT_TRUE(both->knows_position);
    const InertialPrediction predicted = with.predict(last_, nanoseconds(time_s), view_);
    EXPECT_LT(turnError(predicted.world_T_camera, time_s), 1e-3);
  }
}

TEST_F(UnseenMotionOfRobot, WheelsThatTurnOtherwiseThanTheGyroscopeSlip) {
  const UnseenMotion with = driven(true, 2, 2), without = driven(false, 2, 2);
  EXPECT_FALSE(with.carriedByWheels(last_, {}, nanoseconds(4), view_));
  EXPECT_TRUE(without.carriedByWheels(last_, {}, nanoseconds(4), view_));
  EXPECT_LT(turnError(with.predict(last_, nanoseconds(4), view_).world_T_camera, 4), 1e-3) << "by the gyroscope";
}

// A camera that is pushed along x, and a map that is adjusted on the way: no speed comes from that.
TEST(UnseenMotion, WhereTheMapIsAdjustedTheSpeedStaysTheSame) {
  InertialUnit unit;
  MapView view;
  view.inertia.emplace();
  view.inertia->is_known = true;
  view.inertia->gravity = {0, 0, -standard_gravity};
  view.inertia->rate_bias_sigma = 1e-4;
  view.inertia->force_bias_sigma = 1e-3;
  UnseenMotion motion(unit, {}, std::nullopt, {});
  constexpr double push = 0.8;  // [m/s^2]
  for (double time_s = 0; time_s < 2; time_s += 0.005) {
    InertialSample sample;
    sample.time_ns = nanoseconds(time_s);
    sample.force = {push, 0, standard_gravity};
    motion.add(sample);
  }
  const auto frameAt = [&](double time_s, const Eigen::Vector3d& adjusted) {
    FollowedFrame frame;
    auto images = std::make_shared<FrameImages>();
    images->time_ns = nanoseconds(time_s);
    frame.images = images;
    frame.world_T_camera.translation = Eigen::Vector3d(0.5 * push * time_s * time_s, 0, 0) + adjusted;
    frame.covariance.diagonal().setConstant(1e-8);
    return frame;
  };
  const Eigen::Vector3d before = Eigen::Vector3d::Zero(), after(0.1, -0.2, 0.05);
  constexpr int adjusted_at = 25;
  for (int i = 1; i <= 35; ++i) {
    const Eigen::Vector3d& place = i <= adjusted_at ? before : after;
    const FollowedFrame last = frameAt((i - 1) * robot_frame_s, place), now = frameAt(i * robot_frame_s, place);
    motion.observe(last, now, 1e-4, view);
    const double ahead_s = (i + 1) * robot_frame_s;
    if (i < 5) continue;
    const InertialPrediction predicted = motion.predict(now, nanoseconds(ahead_s), view);
    ASSERT_TRUE(predicted.knows_position) << i;
    const Eigen::Vector3d error =
        predicted.world_T_camera.translation - frameAt(ahead_s, place).world_T_camera.translation;
    EXPECT_LT(error.norm(), 1e-3) << i;
    EXPECT_GT(priorOf(predicted).information.diagonal().minCoeff(), 0);
  }
  EXPECT_TRUE(priorOf(InertialPrediction()).information.isZero());
}

}  // namespace
}  // namespace edgeslam
