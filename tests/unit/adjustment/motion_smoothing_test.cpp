// Frames between known ones are where they were measured, and where that tells little, where a camera moves smoothly.
#include "adjustment/motion_smoothing.h"

#include <gtest/gtest.h>

#include "unit/adjustment/synthetic_scene.h"

namespace edgeslam {
namespace {

constexpr std::size_t count = 41, keyframe_interval = 10;

Pose poseAt(double time_s) {
  return {rotationExp({0.2 * std::sin(time_s), 0.3 * time_s, 0.1 * std::cos(time_s)}),
          {0.5 * time_s, 0.2 * std::sin(2 * time_s), 0.1 * time_s * time_s}};
}

std::vector<SmoothedFrame> trueFrames() {
  std::vector<SmoothedFrame> frames;
  for (std::size_t i = 0; i < count; ++i) {
    const double time_s = 0.033 * static_cast<double>(i);
    frames.push_back({time_s, poseAt(time_s), {0.2, 0.2}, i % keyframe_interval == 0});
  }
  return frames;
}

// Measured poses, each with its own error and its information.
struct MeasuredPose {
  Pose world_T_camera;
  Matrix6d information = Matrix6d::Zero();
};

FrameEquations equationsOf(const std::vector<MeasuredPose>& measured) {
  return [&measured](std::size_t i, const Pose& pose) {
    const Pose off = measured[i].world_T_camera.inverse() * pose;
    Vector6d error;
    error << off.translation, rotationLog(off.rotation);
    const Vector6d pull = measured[i].information * error;
    return PoseEquations{error.dot(pull), measured[i].information, pull};
  };
}

// Errs by `sigma` in each direction, and by so much more along the x axis.
std::vector<MeasuredPose> measure(const std::vector<SmoothedFrame>& frames, double sigma, double along_x) {
  test::Random random(11);
  std::vector<MeasuredPose> measured;
  for (const SmoothedFrame& frame : frames) {
    Vector6d sigmas = Vector6d::Constant(sigma), error;
    sigmas[0] = along_x;
    for (int k = 0; k < 6; ++k) error[k] = sigmas[k] * test::uniform(random, -1.7, 1.7);
    MeasuredPose pose{retract(frame.world_T_camera, error)};
    pose.information.diagonal() = sigmas.cwiseAbs2().cwiseInverse();
    measured.push_back(pose);
  }
  return measured;
}

double distanceFromTruth(const std::vector<SmoothedFrame>& frames) {
  double squares = 0;
  for (const SmoothedFrame& frame : frames) {
    squares += (frame.world_T_camera.translation - poseAt(frame.time_s).translation).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(frames.size()));
}

std::vector<SmoothedFrame> startedFrom(const std::vector<MeasuredPose>& measured) {
  std::vector<SmoothedFrame> frames = trueFrames();
  for (std::size_t i = 0; i < count; ++i) {
    if (!frames[i].is_fixed) frames[i].world_T_camera = measured[i].world_T_camera;
  }
  return frames;
}

TEST(MotionSmoothing, DerivativesAreTheNumericOnes) {
  std::vector<SmoothedFrame> frames = trueFrames();
  frames.resize(3);
  frames[1].time_s = 0.03;
  frames[2].time_s = 0.08;
  const SpeedChange change = speedChange(frames[0], frames[1], frames[2]);
  constexpr double step = 1e-6;
  for (std::size_t k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 6; ++axis) {
      std::vector<SmoothedFrame> before = frames, after = frames;
      before[k].world_T_camera = retract(frames[k].world_T_camera, -step * Vector6d::Unit(axis));
      after[k].world_T_camera = retract(frames[k].world_T_camera, step * Vector6d::Unit(axis));
      const Vector6d numeric =
          (speedChange(after[0], after[1], after[2]).residual - speedChange(before[0], before[1], before[2]).residual) /
          (2 * step);
      const double largest = change.by_frame[k].col(axis).norm();
      EXPECT_LT((numeric - change.by_frame[k].col(axis)).norm(), 1e-3 * largest) << k << ", " << axis;
    }
  }
}

TEST(MotionSmoothing, WhatIsHardlyMeasuredFollowsTheMotion) {
  const std::vector<MeasuredPose> measured = measure(trueFrames(), 0.001, 0.1);
  std::vector<SmoothedFrame> frames = startedFrom(measured);
  const double before = distanceFromTruth(frames);
  ASSERT_GT(before, 0.08);
  smoothMotion(equationsOf(measured), 10, frames);
  EXPECT_LT(distanceFromTruth(frames), 0.1 * before);
}

TEST(MotionSmoothing, WhatIsMeasuredWellStays) {
  std::vector<MeasuredPose> measured = measure(trueFrames(), 1e-5, 1e-5);
  measured[7].world_T_camera.translation.x() += 0.01;  // as if something had pushed the camera
  std::vector<SmoothedFrame> frames = startedFrom(measured);
  smoothMotion(equationsOf(measured), 10, frames);
  for (std::size_t i = 0; i < count; ++i) {
    if (frames[i].is_fixed) continue;
    EXPECT_LT((frames[i].world_T_camera.translation - measured[i].world_T_camera.translation).norm(), 2e-4) << i;
  }
}

TEST(MotionSmoothing, FramesThatShowNothingLieOnTheWayBetweenTheOthers) {
  std::vector<MeasuredPose> measured = measure(trueFrames(), 0.001, 0.001);
  std::vector<SmoothedFrame> frames = startedFrom(measured);
  for (std::size_t i = 12; i < 18; ++i) {
    measured[i].information.setZero();
    frames[i].world_T_camera.translation.y() += 0.3;
  }
  smoothMotion(equationsOf(measured), 10, frames);
  for (std::size_t i = 12; i < 18; ++i) {
    EXPECT_LT((frames[i].world_T_camera.translation - poseAt(frames[i].time_s).translation).norm(), 0.01) << i;
    EXPECT_LT(rotationAngle(frames[i].world_T_camera.rotation, poseAt(frames[i].time_s).rotation), 0.01) << i;
  }
}

TEST(MotionSmoothing, KnownPosesStayAndTheSameInputGivesTheSameBits) {
  const std::vector<MeasuredPose> measured = measure(trueFrames(), 0.01, 0.1);
  std::vector<SmoothedFrame> frames = startedFrom(measured), again = frames;
  smoothMotion(equationsOf(measured), 10, frames);
  smoothMotion(equationsOf(measured), 10, again);
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(frames[i].world_T_camera.translation, again[i].world_T_camera.translation);
    EXPECT_EQ(frames[i].world_T_camera.rotation.coeffs(), again[i].world_T_camera.rotation.coeffs());
    if (!frames[i].is_fixed) continue;
    EXPECT_EQ(frames[i].world_T_camera.translation, poseAt(frames[i].time_s).translation);
  }
}

TEST(MotionSmoothing, WithoutFramesOrWithKnownOnesOnlyThereIsNothingToDo) {
  std::vector<SmoothedFrame> none;
  const FrameEquations never = [](std::size_t, const Pose&) -> PoseEquations {
    ADD_FAILURE() << "asked for what is known";
    return {};
  };
  smoothMotion(never, 10, none);
  std::vector<SmoothedFrame> known = trueFrames();
  for (SmoothedFrame& frame : known) frame.is_fixed = true;
  smoothMotion(never, 10, known);
  EXPECT_EQ(distanceFromTruth(known), 0);
}

}  // namespace
}  // namespace edgeslam
