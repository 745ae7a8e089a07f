// A unit that moves against the camera, and what only looks like one.
#include "mapping/loose_unit_check.h"

#include <gtest/gtest.h>

#include "geometry/angles.h"
#include "unit/inertia/turning_camera.h"

namespace edgeslam::test {
namespace {

constexpr std::size_t frames_a_keyframe = 12, most_frames = 600;

// Swings about its x axis against the camera, from a time on.
struct Wobble {
  double angle_rad = 0, frequency_hz = 3;
  double from_s = 0, share = 1;  // of each second in which it does so

  Eigen::Quaterniond at(double time_s) const {
    const bool swings = time_s >= from_s && time_s - std::floor(time_s) < share;
    return rotationExp({swings ? angle_rad * std::sin(2 * M_PI * frequency_hz * time_s) : 0.0, 0, 0});
  }
};

struct Sequence {
  InertialUnit unit;
  std::vector<PosedCamera> frames;
  std::vector<InertialSample> samples;
};

Sequence sequenceOf(const TurningCamera& camera, unsigned seed, const Wobble& wobble = {}) {
  Sequence sequence{{}, camera.poses(seed), camera.samples(seed)};
  sequence.unit.imu_T_camera.rotation = camera.imu_R_camera;
  sequence.unit.rate_walk = camera.rate_walk;
  sequence.unit.offset_ns = std::llround(1e9 * camera.offset_s);
  for (InertialSample& sample : sequence.samples) {
    constexpr double h = 1e-4;
    const double time_s = 1e-9 * static_cast<double>(sample.time_ns) - 100 - camera.offset_s;
    const Eigen::Quaterniond swung = wobble.at(time_s);
    const Eigen::Vector3d swinging =
        rotationLog((wobble.at(time_s - h).conjugate() * wobble.at(time_s + h)).normalized()) / (2 * h);
    sample.rate = swung.conjugate() * sample.rate + swinging;
  }
  return sequence;
}

// When it is said to be loose; negative: never.
double looseAt(const Sequence& sequence) {
  LooseUnitCheck check;
  for (std::size_t i = frames_a_keyframe; i < sequence.frames.size(); i += frames_a_keyframe) {
    const std::size_t begin = i > most_frames ? i - most_frames : 0;
    const std::vector<PosedCamera> frames(sequence.frames.begin() + static_cast<std::ptrdiff_t>(begin),
                                          sequence.frames.begin() + static_cast<std::ptrdiff_t>(i + 1));
    if (!check.look(frames, sequence.samples, sequence.unit)) continue;
    EXPECT_TRUE(check.isLoose());
    EXPECT_GT(check.share(), 0.1);
    EXPECT_GT(check.largest(), radians(1));
    return 1e-9 * static_cast<double>(frames.back().time_ns) - 100;
  }
  return -1;
}

TEST(LooseUnitCheck, AUnitThatSwingsIsLoose) {
  for (const double angle_deg : {1.5, 3.0}) {
    TurningCamera camera;
    camera.pose_noise_rad = 1e-3;
    camera.swing_rad *= 0.3;
    const double loose_s = looseAt(sequenceOf(camera, 1, {radians(angle_deg)}));
    EXPECT_GT(loose_s, 5) << angle_deg;
    EXPECT_LT(loose_s, 10) << angle_deg;
  }
}

TEST(LooseUnitCheck, AUnitThatSwingsNowAndThenFromAMomentOnIsLooseAfterIt) {
  TurningCamera camera;
  camera.seconds = 40;
  camera.pose_noise_rad = 1e-3;
  camera.swing_rad *= 0.3;
  const double loose_s = looseAt(sequenceOf(camera, 2, {radians(3), 4, 20, 0.4}));
  EXPECT_GT(loose_s, 20);
  EXPECT_LT(loose_s, 32);
}

TEST(LooseUnitCheck, AUnitThatSitsFirmlyIsNot) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    TurningCamera camera;
    camera.pose_noise_rad = 3e-3;
    EXPECT_LT(looseAt(sequenceOf(camera, seed)), 0) << "seed " << seed;
    camera.swing_rad.setZero();
    EXPECT_LT(looseAt(sequenceOf(camera, seed)), 0) << "seed " << seed << ", not turning";
  }
}

TEST(LooseUnitCheck, ASmallWobbleIsNone) {
  TurningCamera camera;
  camera.pose_noise_rad = 1e-3;
  EXPECT_LT(looseAt(sequenceOf(camera, 1, {radians(0.3)})), 0);
}

// What the offset, the rotation and the bias explain; that the offset and the rotation are found is not for here.
TEST(LooseUnitCheck, AWrongOffsetRotationOrBiasIsNoLooseUnit) {
  TurningCamera camera;
  camera.pose_noise_rad = 1e-3;
  camera.rate_bias = {0.1, -0.1, 0.1};
  Sequence sequence = sequenceOf(camera, 1);
  sequence.unit.offset_ns += 60'000'000;
  sequence.unit.imu_T_camera.rotation = sequence.unit.imu_T_camera.rotation * rotationExp({0.06, 0, -0.06});
  EXPECT_LT(looseAt(sequence), 0);
}

// A focal length that is 15 % off makes turns about x and y seem so much smaller.
TEST(LooseUnitCheck, AWrongLensIsNoLooseUnit) {
  TurningCamera camera;
  camera.pose_noise_rad = 1e-3;
  Sequence sequence = sequenceOf(camera, 1);
  for (PosedCamera& frame : sequence.frames) {
    frame.world_T_camera.rotation = rotationExp(0.85 * rotationLog(frame.world_T_camera.rotation));
  }
  EXPECT_LT(looseAt(sequence), 0);
}

TEST(LooseUnitCheck, SwappedAxesAreNoLooseUnit) {
  TurningCamera camera;
  camera.pose_noise_rad = 1e-3;
  for (const bool is_mirrored : {false, true}) {
    Sequence sequence = sequenceOf(camera, 1);
    for (InertialSample& sample : sequence.samples) {
      std::swap(sample.rate.x(), sample.rate.y());
      if (!is_mirrored) sample.rate.z() *= -1;
    }
    EXPECT_LT(looseAt(sequence), 0) << (is_mirrored ? "mirrored" : "turned");
  }
}

// Poses that jump are the camera's.
TEST(LooseUnitCheck, FramesThatArePosedWronglyMakeNoLooseUnit) {
  TurningCamera camera;
  camera.pose_noise_rad = 1e-3;
  camera.swing_rad *= 0.3;
  Sequence sequence = sequenceOf(camera, 1);
  for (std::size_t i = 0; i < sequence.frames.size(); i += 20) {
    Eigen::Quaterniond& rotation = sequence.frames[i].world_T_camera.rotation;
    rotation = rotation * rotationExp({0.06, 0, 0});
  }
  EXPECT_LT(looseAt(sequence), 0);
}

}  // namespace
}  // namespace edgeslam::test
