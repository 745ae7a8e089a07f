// P14: the structure that fits best is kept, whatever start it came from.
#include "mapping/initial_rivals.h"

#include <gtest/gtest.h>

#include "mapping/initial_starts.h"
#include "unit/mapping/frames_of_a_scene.h"

namespace edgeslam {
namespace {

const Eigen::Vector3d true_way = Eigen::Vector3d(0.8, -0.5, 0.2).normalized();
const InitialisationOptions default_options;

InitialFrames frames() {
  std::vector<Pose> poses;
  for (int i = 0; i <= 10; ++i) poses.push_back({rotationExp({0.001 * i, -0.002 * i, 0}), 0.03 * i * true_way});
  return test::initialFrames(test::distorted_camera, test::framesOnAWall(2), poses);
}

// As if the camera had gone that way, at the depths of a wall.
InitialStart startTowards(const InitialFrames& frames, const Eigen::Vector3d& way) {
  InitialStart start =
      followedStart(frames, std::vector<double>(frames.first.observations.size(), 1.0), default_options);
  start.method = "given";
  for (std::size_t k = 0; k < start.frames.size(); ++k) {
    const auto i = static_cast<double>(start.frames[k] + 1);
    start.first_T_camera[k] = {rotationExp({0.001 * i, -0.002 * i, 0}), 0.01 * i * way};
  }
  return start;
}

InitialStructure adjusted(const InitialFrames& frames, const InitialStart& start, const InitialisationOptions& with) {
  return adjustInitialStructure(test::distorted_camera, frames, start, with).value();
}

double directionError(const InitialStart& start) {
  return (start.first_T_camera.back().translation.normalized() - true_way).norm();
}

// Not adjusted yet.
InitialStructure wrongStructure(const InitialFrames& frames) {
  InitialisationOptions not_at_all;
  not_at_all.bundle.iterations = 0;
  return adjusted(frames, startTowards(frames, -true_way), not_at_all);
}

TEST(InitialRivals, TheRightOneOfThemWinsAgainstAWrongStructure) {
  const InitialFrames seen = frames();
  const InitialStructure wrong = wrongStructure(seen);
  ASSERT_GT(directionError(wrong), 0.5);
  const InitialStructure best = bestOfRivals(test::distorted_camera, seen, wrong, default_options);
  EXPECT_LT(directionError(best), 0.01);
  EXPECT_LT(best.error, 0.1 * wrong.error);
  EXPECT_EQ(best.inverse_depths.size(), seen.first.observations.size());
  EXPECT_EQ(best.depth_sigmas.size(), seen.first.observations.size());
}

// Steady motions alone: of those along the axes none is right to begin with.
TEST(InitialRivals, SoItDoesWithoutCorners) {
  const InitialFrames seen = frames();
  InitialisationOptions without_corners = default_options;
  without_corners.five_point_corners = 1000;
  EXPECT_LT(directionError(bestOfRivals(test::distorted_camera, seen, wrongStructure(seen), without_corners)), 0.01);
}

TEST(InitialRivals, TheRightStructureStaysAsItIs) {
  const InitialFrames seen = frames();
  const InitialStructure right = adjusted(seen, startTowards(seen, true_way), default_options);
  ASSERT_LT(directionError(right), 0.01);
  const InitialStructure best = bestOfRivals(test::distorted_camera, seen, right, default_options);
  EXPECT_EQ(best.method, "given");
  EXPECT_EQ(best.error, right.error);
  EXPECT_EQ(best.inverse_depths, right.inverse_depths);
}

TEST(InitialRivals, WithoutPointsInCommonThereAreNone) {
  InitialFrames seen = frames();
  const InitialStructure right = adjusted(seen, startTowards(seen, true_way), default_options);
  for (TrackedFrame& frame : seen.since) frame.observations.clear();
  EXPECT_EQ(bestOfRivals(test::distorted_camera, seen, right, default_options).inverse_depths, right.inverse_depths);
}

}  // namespace
}  // namespace edgeslam
