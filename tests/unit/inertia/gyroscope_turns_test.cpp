// How the unit turned between two times, and the derivatives of that.
#include "inertia/gyroscope_turns.h"

#include <gtest/gtest.h>

#include "unit/inertia/turning_camera.h"

namespace edgeslam::test {
namespace {

TurningCamera exactCamera() {
  TurningCamera camera;
  camera.rate_noise = camera.rate_walk = camera.offset_s = 0;
  camera.rate_bias.setZero();
  camera.seconds = 4;
  return camera;
}

std::int64_t atSecond(double seconds) { return std::llround(1e9 * (100 + seconds)); }

TEST(GyroscopeTurns, AreTheTurnsBetweenSamplesToo) {
  const TurningCamera camera = exactCamera();
  const std::vector<InertialSample> samples = camera.samples(1);
  const GyroscopeTurns turns(samples, Eigen::Vector3d::Zero());
  for (const double to_s : {0.5137, 1.2, 3.7771}) {
    const auto turn = turns.between(atSecond(0.4033), atSecond(to_s));
    ASSERT_TRUE(turn);
    const Eigen::Quaterniond seen = camera.orientationAt(0.4033).conjugate() * camera.orientationAt(to_s);
    const Eigen::Quaterniond expected = camera.imu_R_camera * seen * camera.imu_R_camera.conjugate();
    EXPECT_LT(rotationAngle(turn->rotation, expected), 5e-5) << to_s;
    EXPECT_LT((turn->to_rate - camera.imu_R_camera * camera.rateAt(to_s)).norm(), 1e-3);
    EXPECT_LT((turn->from_rate - camera.imu_R_camera * camera.rateAt(0.4033)).norm(), 1e-3);
  }
}

TEST(GyroscopeTurns, TellHowABiasChangesThem) {
  constexpr double step = 1e-4;
  const std::vector<InertialSample> samples = exactCamera().samples(1);
  const Eigen::Vector3d bias(0.02, -0.01, 0.03);
  const auto turn = GyroscopeTurns(samples, bias).between(atSecond(0.4033), atSecond(1.5));
  ASSERT_TRUE(turn);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d change = step * Eigen::Vector3d::Unit(axis);
    const auto more = GyroscopeTurns(samples, bias + change).between(atSecond(0.4033), atSecond(1.5));
    ASSERT_TRUE(more);
    const Eigen::Vector3d numeric = rotationLog(turn->rotation.conjugate() * more->rotation) / step;
    EXPECT_LT((numeric - turn->by_bias.col(axis)).norm(), 5e-3) << axis;
  }
}

TEST(GyroscopeTurns, TellNothingWhereSamplesAreMissing) {
  std::vector<InertialSample> samples = exactCamera().samples(1);
  samples.erase(samples.begin() + 500, samples.begin() + 520);  // from 1.5 s on
  const GyroscopeTurns turns(samples, Eigen::Vector3d::Zero());
  EXPECT_TRUE(turns.between(atSecond(0.5), atSecond(1.4)));
  EXPECT_TRUE(turns.between(atSecond(1.7), atSecond(3)));
  EXPECT_FALSE(turns.between(atSecond(1.4), atSecond(1.7))) << "over the gap";
  EXPECT_FALSE(turns.between(atSecond(0.5), atSecond(1.55))) << "into the gap";
  EXPECT_FALSE(turns.between(atSecond(-1.1), atSecond(0.5)));
  EXPECT_FALSE(turns.between(atSecond(3), atSecond(5.1)));
}

}  // namespace
}  // namespace edgeslam::test
