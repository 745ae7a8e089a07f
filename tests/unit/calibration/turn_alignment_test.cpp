// The rough alignment, which has nothing to begin with.
#include "calibration/turn_alignment.h"

#include <gtest/gtest.h>

#include "unit/inertia/turning_camera.h"

namespace edgeslam::test {
namespace {

TurnAlignment aligned(const TurningCamera& camera, double known_offset_s = 0) {
  return alignTurns(cameraTurns(camera.poses(1), 0.2), camera.samples(1), known_offset_s);
}

TEST(TurnAlignment, FindsAnyRotationAndOffset) {
  for (const Eigen::Vector3d& rotation :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, M_PI), Eigen::Vector3d(1.2, -2, 0.4)}) {
    for (const double offset_s : {-0.43, 0.0, 0.128}) {
      TurningCamera camera;
      camera.imu_R_camera = rotationExp(rotation);
      camera.offset_s = offset_s;
      const TurnAlignment found = aligned(camera);
      EXPECT_LT(rotationAngle(found.imu_R_camera, camera.imu_R_camera), radians(3));
      EXPECT_NEAR(found.offset_s, offset_s, 0.0051);
      EXPECT_LT((found.rate_bias - camera.rate_bias).norm(), 0.01);
      EXPECT_FALSE(found.is_at_end);
      EXPECT_GT(found.mirrored_difference, 3 * found.difference);
    }
  }
}

TEST(TurnAlignment, SearchesAboutTheOffsetThatIsKnown) {
  TurningCamera camera;
  camera.offset_s = 3.2;
  EXPECT_NEAR(aligned(camera, 3).offset_s, 3.2, 0.0051);
}

TEST(TurnAlignment, TellsTheAxesAndTheRatesOfTheTurning) {
  TurningCamera camera;
  camera.swing_rad = {0, 0.3, 0};
  const TurnAlignment found = aligned(camera);
  EXPECT_GT(std::abs(found.axes.col(0).y()), 0.99);
  EXPECT_NEAR(found.common_rates(0), 0.3 * 2.3 / std::sqrt(2), 0.02);
  EXPECT_LT(found.common_rates(1), 0.005);
}

TEST(TurnAlignment, AMirrorFitsAMirroredUnitBetter) {
  const TurningCamera camera;
  std::vector<InertialSample> samples = camera.samples(1);
  for (InertialSample& sample : samples) sample.rate.y() *= -1;
  const TurnAlignment found = alignTurns(cameraTurns(camera.poses(1), 0.2), samples, 0);
  EXPECT_GT(found.difference, 3 * found.mirrored_difference);
  EXPECT_NEAR(found.offset_s, camera.offset_s, 0.0051);
}

}  // namespace
}  // namespace edgeslam::test
