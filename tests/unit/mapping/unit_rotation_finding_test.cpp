// A unit that is turned otherwise is found as frames come, and only where it is.
#include "mapping/unit_rotation_finding.h"

#include <gtest/gtest.h>

#include "unit/inertia/turning_camera.h"

namespace edgeslam::test {
namespace {

constexpr std::size_t frames_a_keyframe = 12, most_frames = 600;

struct Outcome {
  std::optional<FoundUnitRotation> rotation;
  double first_s = -1;  // when one was found first; negative: never
  int changes = 0;
  double too_far_rad = 0;
};

// What a run of a camera finds where the rotation is given wrong by a rotation vector in the camera's frame [rad].
Outcome outcomeWith(const TurningCamera& camera, unsigned seed, const Eigen::Vector3d& wrong) {
  InertialUnit unit;
  unit.imu_T_camera.rotation = camera.imu_R_camera * rotationExp(wrong);
  unit.rate_walk = camera.rate_walk;
  UnitRotationFinding finding(unit);
  const std::vector<PosedCamera> poses = camera.poses(seed);
  const std::vector<InertialSample> samples = camera.samples(seed);
  Outcome outcome;
  for (std::size_t i = frames_a_keyframe; i < poses.size(); i += frames_a_keyframe) {
    const std::size_t begin = i > most_frames ? i - most_frames : 0;
    const std::vector<PosedCamera> frames(poses.begin() + static_cast<std::ptrdiff_t>(begin),
                                          poses.begin() + static_cast<std::ptrdiff_t>(i + 1));
    if (!finding.look(frames, samples, std::llround(1e9 * camera.offset_s))) continue;
    if (outcome.first_s < 0) outcome.first_s = static_cast<double>(i) / camera.frame_rate_hz;
    EXPECT_EQ(outcome.changes == 0, finding.bendsMap()) << "the first one is large, and then it is found better";
    ++outcome.changes;
  }
  outcome.rotation = finding.found();
  outcome.too_far_rad = finding.tooFar();
  return outcome;
}

TEST(UnitRotationFinding, FindsWhatIsWrongWithinTenSeconds) {
  for (const Eigen::Vector3d& degrees_wrong :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(-3, 2, 1)}) {
    TurningCamera camera;
    camera.pose_noise_rad = 1e-3;
    const Outcome outcome = outcomeWith(camera, 3, radians(1) * degrees_wrong);
    ASSERT_TRUE(outcome.rotation) << degrees_wrong.transpose();
    EXPECT_LT(rotationAngle(outcome.rotation->imu_R_camera, camera.imu_R_camera), radians(0.15));
    EXPECT_LT(outcome.rotation->sigma_rad, radians(0.3));
    EXPECT_LT(outcome.first_s, 10) << degrees_wrong.transpose();
    EXPECT_EQ(outcome.too_far_rad, 0);
  }
}

TEST(UnitRotationFinding, LeavesWhatIsRightAsItIs) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    TurningCamera camera;
    camera.seconds = 30;
    camera.pose_noise_rad = 2e-3;
    EXPECT_FALSE(outcomeWith(camera, seed, Eigen::Vector3d::Zero()).rotation) << "seed " << seed;
    EXPECT_FALSE(outcomeWith(camera, seed, radians(0.3) * Eigen::Vector3d::UnitX()).rotation) << "seed " << seed;
  }
}

TEST(UnitRotationFinding, WhatIsTooFarIsToldAndNotUsed) {
  TurningCamera camera;
  const Outcome outcome = outcomeWith(camera, 1, radians(8) * Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(outcome.rotation);
  EXPECT_NEAR(outcome.too_far_rad, radians(8), radians(0.3));
}

TEST(UnitRotationFinding, FindsNothingWhereNothingTellsIt) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    TurningCamera camera;
    camera.seconds = 30;
    camera.swing_rad.setZero();
    EXPECT_FALSE(outcomeWith(camera, seed, radians(2) * Eigen::Vector3d::UnitX()).rotation) << "not turning";
    // The axis of all turns is the one about which it is wrong.
    camera.steady_rate = {0, 0.5, 0};
    EXPECT_FALSE(outcomeWith(camera, seed, radians(2) * Eigen::Vector3d::UnitY()).rotation) << "turning steadily";
  }
}

}  // namespace
}  // namespace edgeslam::test
