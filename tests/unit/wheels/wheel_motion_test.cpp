// The camera's motion by the wheels, and how well it is known.
#include "wheels/wheel_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/uncertainty.h"

namespace edgeslam {
namespace {

// Half a metre forward and a quarter turn to the left, seen by a camera that looks forward.
const Pose body_T_camera{Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.1, 0.02, 0.3}};
const OdometryPlace start{
    {Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ())), {3, -2, 0}}, 4, 10, 2, 0};

OdometryPlace driven(double way_m, double turn_rad) {
  OdometryPlace place = start;
  place.local_T_body = start.local_T_body * Pose{rotationExp(turn_rad * Eigen::Vector3d::UnitZ()), {way_m, 0, 0}};
  place.way_m += std::abs(way_m);
  place.turn_rad += std::abs(turn_rad);
  return place;
}

double turnSigma(const WheelMotion& motion) { return std::sqrt(motion.covariance.diagonal().tail<3>().minCoeff()); }
double waySigma(const WheelMotion& motion) { return std::sqrt(motion.covariance.diagonal().head<3>().maxCoeff()); }

TEST(WheelMotion, IsThatOfTheCameraOnTheBody) {
  const OdometryPlace now = driven(0.5, M_PI / 2);
  const std::optional<WheelMotion> motion = wheelMotion({body_T_camera, false}, start, now);
  ASSERT_TRUE(motion);
  const Pose camera_then = start.local_T_body * body_T_camera, camera_now = now.local_T_body * body_T_camera;
  const Pose error = (camera_then * motion->first_T_second).inverse() * camera_now;
  EXPECT_LT(error.translation.norm() + rotationLog(error.rotation).norm(), 1e-9);
}

TEST(WheelMotion, IsKnownLessWellWhereTheWheelsWereNotHeardYet) {
  OdometryPlace now = driven(0.5, 0.2);
  const WheelMotion heard = *wheelMotion({body_T_camera, false}, start, now);
  now.beyond_s = 0.05;
  const WheelMotion guessed = *wheelMotion({body_T_camera, false}, start, now);
  EXPECT_GT(waySigma(guessed), waySigma(heard));
  EXPECT_GT(turnSigma(guessed), turnSigma(heard));
}

TEST(WheelMotion, IsNotToldBetweenPieces) {
  OdometryPlace other = driven(0.5, 0);
  ++other.piece;
  EXPECT_FALSE(wheelMotion({}, start, other));
  EXPECT_FALSE(wheelMotion({}, start, OdometryPlace()));
  EXPECT_FALSE(wheelMotion({}, OdometryPlace(), OdometryPlace()));
}

TEST(WheelMotion, IsKnownLessWellTheMoreIsDrivenAndTurned) {
  const WheelOptions options{body_T_camera, false};
  double way_sigma = 0, turn_sigma = 0;
  for (const double driven_m : {0.0, 0.1, 0.5, 2.0}) {
    const WheelMotion motion = *wheelMotion(options, start, driven(driven_m, driven_m));
    EXPECT_GT(waySigma(motion), way_sigma);
    EXPECT_GT(turnSigma(motion), turn_sigma);
    way_sigma = waySigma(motion);
    turn_sigma = turnSigma(motion);
  }
  // There and back again is no motion, but was driven all the same.
  OdometryPlace back = start;
  back.way_m += 4;
  const WheelMotion stood = *wheelMotion(options, start, start), returned = *wheelMotion(options, start, back);
  EXPECT_LT(waySigma(stood), 0.005);
  EXPECT_GT(waySigma(returned), 5 * waySigma(stood));
}

TEST(WheelMotion, IsSaidOfTheFloorAlone) {
  const WheelMotion uneven = *wheelMotion({Pose(), false}, start, driven(1, 0));
  const WheelMotion planar = *wheelMotion({Pose(), true}, start, driven(1, 0));
  // How the body turns about the vertical is known as well in both; how it tilts and rises is not.
  EXPECT_DOUBLE_EQ(uneven.covariance(5, 5), planar.covariance(5, 5));
  EXPECT_GT(uneven.covariance(3, 3), 20 * planar.covariance(3, 3));
  EXPECT_GT(uneven.covariance(2, 2), 2 * planar.covariance(2, 2));
  EXPECT_DOUBLE_EQ(uneven.covariance(0, 0), planar.covariance(0, 0));
  EXPECT_GT(planar.covariance(3, 3), 0) << "softly";
}

}  // namespace
}  // namespace edgeslam
