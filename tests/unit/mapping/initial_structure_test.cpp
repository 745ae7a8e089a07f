// P14: the first frames and their points adjusted together, and a frame located against them.
#include "mapping/initial_structure.h"

#include <gtest/gtest.h>

#include "unit/mapping/frames_of_a_scene.h"

namespace edgeslam {
namespace {

const test::EdgeScene near_wall = test::framesOnAWall(3, /*distance=*/1);

std::vector<Pose> turningPath() {
  std::vector<Pose> poses;
  for (int i = 0; i <= 10; ++i) poses.push_back({rotationExp({0, -0.002 * i, 0.001 * i}), {0.015 * i, 0.004 * i, 0}});
  return poses;
}

// The true structure.
InitialStart trueStart(const InitialFrames& frames) {
  InitialStart start;
  start.frames = spreadFrames(frames, 5);
  for (const std::size_t k : start.frames) start.first_T_camera.push_back(turningPath()[k + 1]);
  for (const PointObservation& observation : frames.first.observations)
    start.inverse_depths.push_back(1 / near_wall.points[static_cast<std::size_t>(observation.point)].position.norm());
  return start;
}

TEST(InitialStructure, TheTruthStaysAndFitsTheMeasurements) {
  const InitialFrames frames = test::initialFrames(test::distorted_camera, near_wall, turningPath());
  const auto structure =
      adjustInitialStructure(test::distorted_camera, frames, trueStart(frames), InitialisationOptions());
  ASSERT_TRUE(structure);
  EXPECT_LT(structure->error, 0.01);
  const Pose& end = structure->first_T_camera.back();
  EXPECT_LT(rotationAngle(end.rotation, turningPath().back().rotation), 0.005);
  EXPECT_GT(end.translation.normalized().dot(turningPath().back().translation.normalized()), 0.999);
  EXPECT_EQ(structure->depth_sigmas.size(), frames.first.observations.size());
}

TEST(InitialStructure, OutliersAreLeftOutButCountInItsError) {
  InitialFrames frames = test::initialFrames(test::distorted_camera, near_wall, turningPath());
  for (std::size_t k = 0; k < frames.since.size(); ++k) {
    std::vector<PointObservation>& seen = frames.since[k].observations;
    for (std::size_t j = k; j < seen.size(); j += 20) seen[j].measurement.pixel.x() += j % 3 == 0 ? 60 : -60;
  }
  const auto structure =
      adjustInitialStructure(test::distorted_camera, frames, trueStart(frames), InitialisationOptions());
  ASSERT_TRUE(structure);
  EXPECT_LT(rotationAngle(structure->first_T_camera.back().rotation, turningPath().back().rotation), 0.01);
  EXPECT_GT(structure->error, 0.15);
  EXPECT_LE(structure->error, 9);
}

TEST(InitialStructure, APointThatNoFrameSeesIsNotKnown) {
  InitialFrames frames = test::initialFrames(test::distorted_camera, near_wall, turningPath());
  for (TrackedFrame& frame : frames.since) {
    const auto end = std::remove_if(frame.observations.begin(), frame.observations.end(),
                                    [](const PointObservation& o) { return o.point == 0; });
    frame.observations.erase(end, frame.observations.end());
  }
  ASSERT_EQ(frames.first.observations.front().point, 0);
  const InitialisationOptions options;
  const auto structure = adjustInitialStructure(test::distorted_camera, frames, trueStart(frames), options);
  ASSERT_TRUE(structure);
  EXPECT_EQ(structure->depth_sigmas.front(), options.prior_sigma);
  EXPECT_FALSE(structure->isKnown(0, options.largest_depth_sigma));
  EXPECT_TRUE(structure->isKnown(1, options.largest_depth_sigma));
}

TEST(InitialStructure, WithoutMeasurementsThereIsNone) {
  InitialFrames frames = test::initialFrames(test::distorted_camera, near_wall, turningPath());
  const InitialStart start = trueStart(frames);
  for (TrackedFrame& frame : frames.since) frame.observations.clear();
  EXPECT_FALSE(adjustInitialStructure(test::distorted_camera, frames, start, InitialisationOptions()));
}

TEST(InitialStructure, AFrameIsLocatedFromAPoseNearIt) {
  const InitialFrames frames = test::initialFrames(test::distorted_camera, near_wall, turningPath());
  const InitialStart start = trueStart(frames);
  const auto located =
      locateAgainst(test::distorted_camera, frames.first, start.inverse_depths, frames.since[4], turningPath()[4]);
  ASSERT_TRUE(located);
  EXPECT_LT(test::distance(*located, turningPath()[5]), 1e-6);
  const std::vector<double> unknown(start.inverse_depths.size(), 0);
  EXPECT_FALSE(locateAgainst(test::distorted_camera, frames.first, unknown, frames.since[4], turningPath()[4]));
}

}  // namespace
}  // namespace edgeslam
