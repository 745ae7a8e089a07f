// The offset of an inertial unit's clock, from simulated turns; and what does not tell it.
#include "mapping/time_offset_estimate.h"

#include <gtest/gtest.h>

#include "unit/inertia/turning_camera.h"

namespace edgeslam::test {
namespace {

constexpr double farthest_s = 0.1;

InertialUnit unitOf(const TurningCamera& camera) {
  InertialUnit unit;
  unit.imu_T_camera.rotation = camera.imu_R_camera;
  unit.rate_walk = camera.rate_walk;
  return unit;
}

std::optional<TimeOffsetEstimate> estimateOf(const TurningCamera& camera, unsigned seed, double given_s = 0) {
  return estimateTimeOffset(camera.poses(seed), camera.samples(seed), unitOf(camera), given_s, farthest_s);
}

TEST(TimeOffsetEstimate, FindsOffsetsAsWellAsItSays) {
  double squares = 0;
  int count = 0;
  for (const double offset_s : {-0.095, -0.06, -0.03, -0.01, 0.0, 0.004, 0.01, 0.03, 0.06, 0.095}) {
    for (unsigned seed = 0; seed < 6; ++seed) {
      TurningCamera camera;
      camera.offset_s = offset_s;
      camera.seconds = seed < 3 ? 6 : 20;
      camera.pose_noise_rad = 1e-3;
      const std::optional<TimeOffsetEstimate> estimate = estimateOf(camera, seed);
      ASSERT_TRUE(estimate) << offset_s << ", seed " << seed;
      const double sigmas = (estimate->offset_s - offset_s) / estimate->sigma_s;
      EXPECT_LT(std::abs(sigmas), 4) << offset_s << ", seed " << seed;
      EXPECT_LT(estimate->sigma_s, 1e-3);
      EXPECT_NEAR(estimate->seconds, camera.seconds, 0.25);
      squares += sigmas * sigmas;
      ++count;
    }
  }
  // It allows for errors of poses that go with the motion, which these poses have not.
  EXPECT_LT(squares / count, 1.2);
  EXPECT_GT(squares / count, 0.1);
}

TEST(TimeOffsetEstimate, IsAboutTheOneThatIsGiven) {
  TurningCamera camera;
  camera.offset_s = 0.55;
  const std::optional<TimeOffsetEstimate> estimate = estimateOf(camera, 1, 0.5);
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->offset_s, 0.55, 5e-4);
}

TEST(TimeOffsetEstimate, StandsWrongFramesAndAUnitThatIsMountedALittleOtherwise) {
  TurningCamera camera;
  std::vector<PosedCamera> frames = camera.poses(1);
  for (std::size_t i = 10; i < frames.size(); i += 50) {
    frames[i].world_T_camera.rotation = frames[i].world_T_camera.rotation * rotationExp({0.3, 0.1, -0.2});
  }
  InertialUnit unit = unitOf(camera);
  unit.imu_T_camera.rotation = unit.imu_T_camera.rotation * rotationExp({0.03, -0.02, 0.03});
  const auto estimate = estimateTimeOffset(frames, camera.samples(1), unit, 0, farthest_s);
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->offset_s, camera.offset_s, 1e-3);
}

TEST(TimeOffsetEstimate, IsNotToldByACameraThatDoesNotTurn) {
  TurningCamera camera;
  camera.swing_rad.setZero();
  for (unsigned seed = 0; seed < 5; ++seed) {
    const std::optional<TimeOffsetEstimate> estimate = estimateOf(camera, seed);
    if (estimate) {
      EXPECT_GT(estimate->sigma_s, 0.01) << "seed " << seed;
    }
  }
}

TEST(TimeOffsetEstimate, IsNotToldByASteadyTurn) {
  TurningCamera camera;
  camera.swing_rad.setZero();
  camera.steady_rate = {0.1, 0.5, -0.2};
  for (unsigned seed = 0; seed < 5; ++seed) {
    const std::optional<TimeOffsetEstimate> estimate = estimateOf(camera, seed);
    if (estimate) {
      EXPECT_GT(estimate->sigma_s, 0.01) << "seed " << seed;
    }
  }
}

TEST(TimeOffsetEstimate, IsNoneWhereItIsFartherThanIsTried) {
  TurningCamera camera;
  for (const double offset_s : {-0.13, 0.13}) {
    camera.offset_s = offset_s;
    EXPECT_FALSE(estimateOf(camera, 1)) << offset_s;
  }
}

TEST(TimeOffsetEstimate, IsNoneWhereTheGyroscopeContradictsTheCamera) {
  const TurningCamera camera;
  InertialUnit unit = unitOf(camera);
  unit.imu_T_camera.rotation = unit.imu_T_camera.rotation.conjugate();
  EXPECT_FALSE(estimateTimeOffset(camera.poses(1), camera.samples(1), unit, 0, farthest_s));
  EXPECT_FALSE(estimateTimeOffset(camera.poses(1), {}, unitOf(camera), 0, farthest_s)) << "nothing was felt";
}

}  // namespace
}  // namespace edgeslam::test
