// P14: each start finds a steady motion along its own direction, and has depths in one unit.
#include "mapping/initial_starts.h"

#include <gtest/gtest.h>

#include "geometry/median.h"
#include "unit/mapping/frames_of_a_scene.h"

namespace edgeslam {
namespace {

InitialFrames framesTowards(const Eigen::Vector3d& direction) {
  std::vector<Pose> poses;
  for (int i = 0; i <= 20; ++i) poses.push_back({rotationExp({0.001 * i, -0.002 * i, 0}), 0.03 * i * direction});
  return test::initialFrames(test::distorted_camera, test::framesOnAWall(2), poses);
}

const InitialStart* named(const std::vector<InitialStart>& starts, const std::string& method) {
  const auto found =
      std::find_if(starts.begin(), starts.end(), [&](const InitialStart& start) { return start.method == method; });
  return found == starts.end() ? nullptr : &*found;
}

double directionErrorRad(const InitialStart& start, const Eigen::Vector3d& direction) {
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
  const std::optional<InitialStart> start = fivePointStart(test::distorted_camera, framesTowards(direction), options);
  ASSERT_TRUE(start);
  EXPECT_EQ(start->method, "five-point");
  EXPECT_LT(directionErrorRad(*start, direction), 0.01);
  options.five_point_corners = 1000;
  EXPECT_FALSE(fivePointStart(test::distorted_camera, framesTowards(direction), options));
}

TEST(InitialStarts, SteadyMotionsGoAlongTheAxes) {
  const std::vector<std::pair<std::string, Eigen::Vector3d>> directions = {{"rightward start", {1, 0, 0}},
                                                                           {"leftward start", {-1, 0, 0}},
                                                                           {"downward start", {0, 1, 0}},
                                                                           {"upward start", {0, -1, 0}}};
  for (const auto& [name, direction] : directions) {
    const InitialFrames frames = framesTowards(direction);
    const std::vector<InitialStart> starts =
        steadyMotionStarts(test::distorted_camera, frames, InitialisationOptions());
    const InitialStart* start = named(starts, name);
    ASSERT_NE(start, nullptr) << name;
    EXPECT_LT(directionErrorRad(*start, direction), 1e-6) << name;
    ASSERT_EQ(start->inverse_depths.size(), frames.first.observations.size());
    std::vector<double> depths = start->inverse_depths;
    EXPECT_NEAR(upperMedian(depths), 1, 0.1) << name;
    for (const double depth : depths) EXPECT_GT(depth, 0);
  }
}

TEST(InitialStarts, DepthsFollowFromTheMotion) {
  const InitialFrames frames = framesTowards({1, 0, 0});
  const std::vector<double> unknown(frames.first.observations.size(), 0);
  InitialStart start = followedStart(frames, unknown, InitialisationOptions());
  const std::optional<InitialStart> found = withTriangulatedDepths(test::distorted_camera, frames, start);
  ASSERT_TRUE(found);
  const test::EdgeScene scene = test::framesOnAWall(2);
  const double scale = found->first_T_camera.back().translation.x() / start.first_T_camera.back().translation.x();
  for (std::size_t i = 0; i < unknown.size(); ++i) {
    const auto point = static_cast<std::size_t>(frames.first.observations[i].point);
    if (found->inverse_depths[i] == 1) continue;  // too little is known of it
    EXPECT_NEAR(scale * found->inverse_depths[i] * scene.points[point].position.norm(), 1, 0.02) << i;
  }
  for (Pose& pose : start.first_T_camera) pose.translation.setZero();
  EXPECT_FALSE(withTriangulatedDepths(test::distorted_camera, frames, start));
}

TEST(InitialStarts, ThereIsNoneWithoutPointsInCommon) {
  InitialFrames frames = framesTowards({1, 0, 0});
  for (TrackedFrame& frame : frames.since) frame.observations.clear();
  EXPECT_FALSE(fivePointStart(test::distorted_camera, frames, InitialisationOptions()));
  EXPECT_TRUE(steadyMotionStarts(test::distorted_camera, frames, InitialisationOptions()).empty());
}

}  // namespace
}  // namespace edgeslam
