// Poses by the wheels, and wheels that are not believed: they slip, or stand where the camera moves.
#include "tracking/motion_by_wheels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "unit/tracking/circling_robot.h"

namespace edgeslam {
namespace {

const WheelScale known_scale{true, robot_metres_a_unit, 0.02};
const WheelOptions robot_wheels{robot_T_camera, false};

// Where the robot is, which drives at 0.3 m/s.
Pose slowCircle(double time_s) { return onCircle(0.3 * time_s); }

Matrix6d cameraCovariance() {
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << 1e-6, 1e-6, 1e-6, 1e-7, 1e-7, 1e-7;
  return covariance;
}

class MotionByWheelsOfRobot : public testing::Test {
 protected:
  // Frames from `from_s` to `to_s`, all of them located; the wheels are told `body` and the camera is on `truth`.
  void drive(double from_s, double to_s, const std::function<Pose(double)>& truth,
             const std::function<Pose(double)>& body) {
    for (double time_s = from_s; time_s < to_s - 1e-9; time_s += robot_frame_s) {
      motion_.add({nanoseconds(time_s) / 1000, body(time_s)});
      motion_.observe({nanoseconds(last_s_), last_}, {nanoseconds(time_s), cameraAt(truth(time_s))}, cameraCovariance(),
                      known_scale);
      last_s_ = time_s;
      last_ = cameraAt(truth(time_s));
    }
  }
  static Pose cameraAt(const Pose& world_T_body) {
    const Pose world_T_camera = world_T_body * robot_T_camera;
    return {world_T_camera.rotation, world_T_camera.translation / robot_metres_a_unit};
  }
  std::optional<WheelPrediction> predictAt(double time_s, const WheelScale& known = known_scale) const {
    const OdometryPlace place = motion_.at(nanoseconds(last_s_));
    return motion_.predict({{nanoseconds(last_s_), last_}, place, place, cameraCovariance()}, nanoseconds(time_s),
                           known, {last_, cameraCovariance(), false, false});
  }

  MotionByWheels motion_{robot_wheels};
  double last_s_ = 0;
  Pose last_;
};

TEST_F(MotionByWheelsOfRobot, CarriesTheCameraOnWithCovariancesThatGrow) {
  drive(0, 2, slowCircle, slowCircle);
  double before = 0;
  for (double time_s = 2; time_s < 6; time_s += robot_frame_s) {
    motion_.add({nanoseconds(time_s) / 1000, slowCircle(time_s)});
    const std::optional<WheelPrediction> prediction = predictAt(time_s);
    ASSERT_TRUE(prediction);
    EXPECT_TRUE(prediction->knows_position);
    EXPECT_FALSE(prediction->stood);
    const Pose error = prediction->world_T_camera.inverse() * cameraAt(slowCircle(time_s));
    EXPECT_LT(error.translation.norm() + rotationLog(error.rotation).norm(), 1e-6);
    const double sigma = std::sqrt(prediction->covariance.topLeftCorner<3, 3>().trace());
    EXPECT_GT(sigma, before);
    before = sigma;
  }
  EXPECT_GT(before * robot_metres_a_unit, 0.03);
  EXPECT_LT(before * robot_metres_a_unit, 0.3);
}

TEST_F(MotionByWheelsOfRobot, TellsTurnsAloneWhereTheScaleIsNotKnown) {
  drive(0, 2, slowCircle, slowCircle);
  motion_.add({nanoseconds(2) / 1000, slowCircle(2)});
  const std::optional<WheelPrediction> prediction = predictAt(2, {});
  ASSERT_TRUE(prediction);
  EXPECT_FALSE(prediction->knows_position);
  EXPECT_LT(rotationAngle(prediction->world_T_camera.rotation, cameraAt(slowCircle(2)).rotation), 1e-6);
  EXPECT_EQ(prediction->world_T_camera.translation, last_.translation);
}

TEST_F(MotionByWheelsOfRobot, IsNotBelievedWhileTheWheelsSlip) {
  const auto spinning = [](double time_s) {
    Pose body = slowCircle(std::min(time_s, 2.0));
    body.translation += body.rotation * Eigen::Vector3d(std::max(0.0, time_s - 2), 0, 0);
    return body;
  };
  const auto stuck = [](double time_s) { return slowCircle(std::min(time_s, 2.0)); };
  drive(0, 2, slowCircle, slowCircle);
  const OdometryPlace before = motion_.at(nanoseconds(last_s_));
  EXPECT_GE(before.piece, 0);
  drive(2, 3, stuck, spinning);
  EXPECT_FALSE(motion_.areBelieved());
  EXPECT_LT(motion_.at(nanoseconds(last_s_)).piece, 0);
  EXPECT_FALSE(predictAt(last_s_));
  // Once they roll again they are believed again, but not for what was before.
  const auto onward = [&](double time_s) { return spinning(3) * (slowCircle(3).inverse() * slowCircle(time_s)); };
  const auto truly = [&](double time_s) { return stuck(3) * (slowCircle(3).inverse() * slowCircle(time_s)); };
  drive(3, 5.5, truly, onward);
  EXPECT_TRUE(motion_.areBelieved());
  const OdometryPlace after = motion_.at(nanoseconds(last_s_));
  EXPECT_GE(after.piece, 0);
  EXPECT_FALSE(wheelMotion(robot_wheels, before, after));
}

TEST_F(MotionByWheelsOfRobot, StaysBelievedWhereTheMapIsAdjusted) {
  const Pose adjustment{rotationExp({0, 0, 0.3}), {0.5, -0.4, 0}};
  const auto adjusted = [&](double time_s) { return adjustment * slowCircle(time_s); };
  drive(0, 2, slowCircle, slowCircle);
  last_ = cameraAt(adjusted(last_s_));
  const OdometryPlace before = motion_.at(nanoseconds(last_s_));
  drive(2, 3, adjusted, slowCircle);
  EXPECT_TRUE(motion_.areBelieved());
  EXPECT_EQ(motion_.at(nanoseconds(last_s_)).piece, before.piece) << "nor were they doubted meanwhile";
}

TEST_F(MotionByWheelsOfRobot, IsNotBelievedWhereTheRobotIsCarriedAround) {
  drive(0, 2, slowCircle, slowCircle);
  // Lifted and turned, with wheels that stand; also where no scale is known, the turns tell.
  drive(2, 3, slowCircle, [](double) { return slowCircle(2); });
  EXPECT_FALSE(motion_.areBelieved());
}

TEST_F(MotionByWheelsOfRobot, StandsWhereTheWheelsStand) {
  drive(0, 2, slowCircle, slowCircle);
  motion_.add({nanoseconds(2) / 1000, slowCircle(last_s_)});
  ASSERT_TRUE(predictAt(2));
  EXPECT_TRUE(predictAt(2)->stood);
}

TEST_F(MotionByWheelsOfRobot, KnowsNothingWithoutWheelsOrPoses) {
  MotionByWheels none(std::nullopt);
  none.add({0, Pose()});
  EXPECT_LT(none.at(0).piece, 0);
  EXPECT_FALSE(predictAt(1));
  drive(0, 2, slowCircle, slowCircle);
  EXPECT_FALSE(predictAt(3)) << "it is not told yet";
}

}  // namespace
}  // namespace edgeslam
