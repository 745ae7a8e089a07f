// An offset of the clocks is found in what comes keyframe by keyframe, and only where there is one.
#include "mapping/time_offset_finding.h"

#include <gtest/gtest.h>

#include "unit/inertia/turning_camera.h"

namespace edgeslam::test {
namespace {

constexpr int frames_a_keyframe = 12;

struct Found {
  std::optional<FoundTimeOffset> offset;
  double first_s = -1;  // when one was found first; negative: never
  int changes = 0;
  bool comes_in_time = false;
};

// What a run of a camera finds with an offset that is given; a unit's samples come until `early_s` after a frame.
Found foundIn(const TurningCamera& camera, unsigned seed, double given_s, double early_s = 0.005) {
  InertialUnit unit;
  unit.imu_T_camera.rotation = camera.imu_R_camera;
  unit.rate_walk = camera.rate_walk;
  unit.offset_ns = std::llround(1e9 * given_s);
  TimeOffsetFinding finding(unit);
  const std::vector<PosedCamera> poses = camera.poses(seed);
  const std::vector<InertialSample> samples = camera.samples(seed);
  Found found;
  std::vector<InertialSample> felt;
  std::vector<CameraTurn> turns;
  std::size_t next = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    turns.push_back({poses[i - 1].time_ns, poses[i].time_ns,
                     poses[i - 1].world_T_camera.rotation.conjugate() * poses[i].world_T_camera.rotation});
    if (i % frames_a_keyframe != 0) continue;
    while (samples[next].time_ns <= poses[i].time_ns + std::llround(1e9 * early_s)) felt.push_back(samples[next++]);
    const bool is_other = finding.add(poses[i].time_ns, felt, turns);
    if (is_other && found.first_s < 0) found.first_s = static_cast<double>(i) / camera.frame_rate_hz;
    found.changes += is_other ? 1 : 0;
    felt.clear();
    turns.clear();
  }
  found.offset = finding.found();
  found.comes_in_time = finding.comesInTime();
  return found;
}

TEST(TimeOffsetFinding, FindsWhatIsOffWithinEightSeconds) {
  for (const double offset_s : {-0.06, -0.02, 0.01, 0.04, 0.08}) {
    TurningCamera camera;
    camera.offset_s = offset_s;
    camera.pose_noise_rad = 1e-3;
    const Found found = foundIn(camera, 3, 0);
    ASSERT_TRUE(found.offset) << offset_s;
    EXPECT_NEAR(1e-9 * static_cast<double>(found.offset->offset_ns), offset_s, 1e-3);
    EXPECT_LT(found.first_s, 8) << offset_s;
    EXPECT_LE(found.changes, 3) << "it comes to stay";
  }
}

// A unit whose clock is ahead by more than its samples come before the frames.
TEST(TimeOffsetFinding, KnowsWhenSamplesComeTooLate) {
  TurningCamera camera;
  camera.offset_s = 0.05;
  for (const double early_s : {0.005, 0.1}) {
    const Found found = foundIn(camera, 1, 0, early_s);
    ASSERT_TRUE(found.offset);
    EXPECT_EQ(found.comes_in_time, early_s > 0.05) << early_s;
  }
}

TEST(TimeOffsetFinding, LeavesWhatIsRightAsItIs) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    TurningCamera camera;
    camera.seconds = 40;
    camera.pose_noise_rad = 2e-3;
    EXPECT_FALSE(foundIn(camera, seed, camera.offset_s).offset) << "seed " << seed;
    EXPECT_FALSE(foundIn(camera, seed, camera.offset_s + 0.001).offset) << "seed " << seed;
  }
}

TEST(TimeOffsetFinding, FindsNothingWhereNothingTellsIt) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    TurningCamera camera;
    camera.seconds = 30;
    camera.swing_rad.setZero();
    EXPECT_FALSE(foundIn(camera, seed, 0).offset) << "seed " << seed << ", not turning";
    camera.steady_rate = {0.1, 0.5, -0.2};
    EXPECT_FALSE(foundIn(camera, seed, 0).offset) << "seed " << seed << ", turning steadily";
  }
}

}  // namespace
}  // namespace edgeslam::test
