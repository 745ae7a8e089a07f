// P14: each start finds a steady motion along its own direction, and has depths in one unit.
#include "mapping/initial_starts.h"

#include <gtest/gtest.h>

#include "geometry/median.h"
#include "unit/mapping/frames_of_a_scene.h"

namespace edgeslam {
namespace {

const Camera camera = test::testCamera(CameraModel::pinhole_radial_tangential);

InitialFrames framesTowards(const Eigen::Vector3d& direction) {
  std::vector<Pose> poses;
  for (int i = 0; i <= 20; ++i) poses.push_back({rotationExp({0.001 * i, -0.002 * i, 0}), 0.03 * i * direction});
  return test::initialFrames(camera, test::framesOnAWall(2), poses);
}

const InitialStart* named(const std::vector<InitialStart>& starts, const std::string& method) {
  const auto found =
      std::find_if(starts.begin(), starts.end(), [&](const InitialStart& start) { return start.method == method; });
  return found == starts.end() ? nullptr : &*found;
}

double directionError(const InitialStart& start, const Eigen::Vector3d& direction) {
  return std::acos(std::clamp(start.first_T_camera.back().translation.normalized().dot(direction), -1.0, 1.0));
}

TEST(InitialStarts, TheFollowedStartIsWhatTrackingSays) {
  const InitialFrames frames = framesTowards({1, 0, 0});
  const std::vector<double> depths(frames.first.observations.size(), 1.0);
  const InitialStart start = followedStart(frames, depths, InitialisationOptions());
  EXPECT_EQ(start.method, "flat start");
  EXPECT_EQ(start.inverse_depths, depths);
  ASSERT_EQ(start.frames.size(), 9U);
  EXPECT_EQ(start.frames.back(), 19U);
  for (std::size_t k = 0; k < start.frames.size(); ++k)
    EXPECT_EQ(start.first_T_camera[k].translation, frames.since[start.frames[k]].world_T_camera.translation);
}

TEST(InitialStarts, TheFivePointStartFindsAnyDirection) {
  const Eigen::Vector3d direction = Eigen::Vector3d(0.6, -0.5, 0.3).normalized();
  InitialisationOptions options;
  const std::vector<InitialStart> starts = rivalStarts(camera, framesTowards(direction), options);
  const InitialStart* start = named(starts, "five-point");
  ASSERT_NE(start, nullptr);
  EXPECT_LT(directionError(*start, direction), 0.01);
  options.five_point_corners = 1000;
  EXPECT_EQ(named(rivalStarts(camera, framesTowards(direction), options), "five-point"), nullptr);
}

TEST(InitialStarts, SteadyMotionsGoAlongTheAxes) {
  const std::vector<std::pair<std::string, Eigen::Vector3d>> directions = {{"rightward start", {1, 0, 0}},
                                                                           {"leftward start", {-1, 0, 0}},
                                                                           {"downward start", {0, 1, 0}},
                                                                           {"upward start", {0, -1, 0}}};
  for (const auto& [name, direction] : directions) {
    const InitialFrames frames = framesTowards(direction);
    const std::vector<InitialStart> starts = rivalStarts(camera, frames, InitialisationOptions());
    const InitialStart* start = named(starts, name);
    ASSERT_NE(start, nullptr) << name;
    EXPECT_LT(directionError(*start, direction), 1e-6) << name;
    ASSERT_EQ(start->inverse_depths.size(), frames.first.observations.size());
    std::vector<double> depths = start->inverse_depths;
    EXPECT_NEAR(upperMedian(depths), 1, 0.1) << name;
    for (const double depth : depths) EXPECT_GT(depth, 0);
  }
}

TEST(InitialStarts, ThereIsNoneWithoutPointsInCommon) {
  InitialFrames frames = framesTowards({1, 0, 0});
  for (TrackedFrame& frame : frames.since) frame.observations.clear();
  EXPECT_TRUE(rivalStarts(camera, frames, InitialisationOptions()).empty());
}

}  // namespace
}  // namespace edgeslam
