// P14: the structure that fits best is kept, whatever start it came from.
#include "mapping/initial_rivals.h"

#include <gtest/gtest.h>

#include "mapping/initial_starts.h"
#include "unit/mapping/frames_of_a_scene.h"

namespace edgeslam {
namespace {

const Camera camera = test::testCamera(CameraModel::pinhole_radial_tangential);
const Eigen::Vector3d direction = Eigen::Vector3d(0.8, -0.5, 0.2).normalized();
const InitialisationOptions options;

InitialFrames frames() {
  std::vector<Pose> poses;
  for (int i = 0; i <= 10; ++i) poses.push_back({rotationExp({0.001 * i, -0.002 * i, 0}), 0.03 * i * direction});
  return test::initialFrames(camera, test::framesOnAWall(2), poses);
}

// As if the camera had gone that way, at the depths of a wall.
InitialStart startTowards(const InitialFrames& frames, const Eigen::Vector3d& way) {
  InitialStart start = followedStart(frames, std::vector<double>(frames.first.observations.size(), 1.0), options);
  start.method = "given";
  for (std::size_t k = 0; k < start.frames.size(); ++k) {
    const auto i = static_cast<double>(start.frames[k] + 1);
    start.first_T_camera[k] = {rotationExp({0.001 * i, -0.002 * i, 0}), 0.01 * i * way};
  }
  return start;
}

InitialStructure adjusted(const InitialFrames& frames, const InitialStart& start, const InitialisationOptions& with) {
  return adjustInitialStructure(camera, frames, start, with).value();
}

double directionError(const InitialStart& start) {
  return (start.first_T_camera.back().translation.normalized() - direction).norm();
}

// Not adjusted yet.
InitialStructure wrongStructure(const InitialFrames& frames) {
  InitialisationOptions not_at_all;
  not_at_all.bundle.iterations = 0;
  return adjusted(frames, startTowards(frames, -direction), not_at_all);
}

TEST(InitialRivals, TheRightOneOfThemWinsAgainstAWrongStructure) {
  const InitialFrames seen = frames();
  const InitialStructure wrong = wrongStructure(seen);
  ASSERT_GT(directionError(wrong), 0.5);
  const InitialStructure best = bestOfRivals(camera, seen, wrong, options);
  EXPECT_LT(directionError(best), 0.01);
  EXPECT_LT(best.error, 0.1 * wrong.error);
  EXPECT_EQ(best.inverse_depths.size(), seen.first.observations.size());
  EXPECT_EQ(best.depth_sigmas.size(), seen.first.observations.size());
}

// Steady motions alone: of those along the axes none is right to begin with.
TEST(InitialRivals, SoItDoesWithoutCorners) {
  const InitialFrames seen = frames();
  InitialisationOptions without_corners = options;
  without_corners.five_point_corners = 1000;
  EXPECT_LT(directionError(bestOfRivals(camera, seen, wrongStructure(seen), without_corners)), 0.01);
}

TEST(InitialRivals, TheRightStructureStaysAsItIs) {
  const InitialFrames seen = frames();
  const InitialStructure right = adjusted(seen, startTowards(seen, direction), options);
  ASSERT_LT(directionError(right), 0.01);
  const InitialStructure best = bestOfRivals(camera, seen, right, options);
  EXPECT_EQ(best.method, "given");
  EXPECT_EQ(best.error, right.error);
  EXPECT_EQ(best.inverse_depths, right.inverse_depths);
}

TEST(InitialRivals, WithoutPointsInCommonThereAreNone) {
  InitialFrames seen = frames();
  const InitialStructure right = adjusted(seen, startTowards(seen, direction), options);
  for (TrackedFrame& frame : seen.since) frame.observations.clear();
  EXPECT_EQ(bestOfRivals(camera, seen, right, options).inverse_depths, right.inverse_depths);
}

}  // namespace
}  // namespace edgeslam
