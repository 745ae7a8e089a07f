// P14: the relative pose of two views, where the matches' errors run on from good to bad without a gap.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/epipolar.h"
#include "unit/geometry/scene_fixture.h"

namespace edgeslam {
namespace {

struct NoisyMatches {
  Pose second_T_first;
  std::vector<Eigen::Vector3d> first, second;
};

// Matches of points in a room, off by up to `farthest` [px] any way, each as likely.
NoisyMatches noisyMatches(unsigned seed, int count, double farthest) {
  const Camera camera = pinholeCamera();
  Random random(seed);
  NoisyMatches matches;
  matches.second_T_first = {random.rotation(0.15), 0.6 * random.direction()};
  while (static_cast<int>(matches.first.size()) < count) {
    const Eigen::Vector3d ray = bearing(camera, randomPixel(camera, random));
    const Eigen::Vector3d seen = matches.second_T_first * (random.uniform(2, 6) * ray);
    if (seen.z() < 0.1 || !insideImage(camera, project(camera, seen))) continue;
    const double angle = random.uniform(0, 2 * M_PI), far = random.uniform(0, farthest);
    const Eigen::Vector2d pixel = project(camera, seen) + far * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    matches.first.push_back(ray);
    matches.second.push_back(bearing(camera, pixel));
  }
  return matches;
}

// How far the two bearings together must turn to meet the epipolar constraint, squared [rad^2].
double squaredEpipolarError(const Pose& pose, const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  const Eigen::Vector3d turned = pose.rotation * first;
  const double constraint = pose.translation.dot(turned.cross(second));
  return constraint * constraint /
         (pose.translation.cross(turned).squaredNorm() + pose.translation.cross(second).squaredNorm());
}

// Tukey's cost, one for whatever is off by two thresholds or more.
double tukeyCost(const Pose& pose, const NoisyMatches& matches) {
  double cost = 0;
  for (std::size_t i = 0; i < matches.first.size(); ++i) {
    const double closeness =
        1 - squaredEpipolarError(pose, matches.first[i], matches.second[i]) / (4 * one_pixel_rad * one_pixel_rad);
    cost += closeness > 0 ? 1 - closeness * closeness * closeness : 1;
  }
  return cost;
}

Pose turnedBy(const Pose& pose, int unknown, double step) {
  if (unknown < 3) return {rotationExp(step * Eigen::Vector3d::Unit(unknown)) * pose.rotation, pose.translation};
  const Eigen::Vector3d tangent = pose.translation.unitOrthogonal();
  const Eigen::Vector3d way = unknown == 3 ? tangent : Eigen::Vector3d(pose.translation.cross(tangent));
  return {pose.rotation, (pose.translation + step * way).normalized()};
}

// The refinement goes on past matches that come into and fall out of the width on its way. What a hundred thousandth of
// a radian more would gain is told in matches; each of the thirty hardly gains a thousandth of one.
TEST(EpipolarRefinement, EndsWhereNoPoseNearByExplainsTheMatchesBetter) {
  constexpr unsigned trials = 30;
  double gained = 0;
  for (unsigned seed = 0; seed < trials; ++seed) {
    const NoisyMatches matches = noisyMatches(seed, 200, 5);
    const RelativePose found = relativePose(matches.first, matches.second, one_pixel_rad, seed);
    ASSERT_TRUE(found.found) << seed;
    const double cost = tukeyCost(found.second_T_first, matches);
    double most = 0;
    for (int unknown = 0; unknown < 5; ++unknown) {
      for (const double step : {-1e-5, 1e-5}) {
        most = std::max(most, cost - tukeyCost(turnedBy(found.second_T_first, unknown, step), matches));
      }
    }
    gained += most;
  }
  EXPECT_LT(gained / trials, 0.0017);
}

TEST(EpipolarRefinement, InliersAreTheMatchesWithinTheThresholdInFrontOfBothCameras) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const NoisyMatches matches = noisyMatches(seed, 200, 3);
    const RelativePose found = relativePose(matches.first, matches.second, one_pixel_rad, seed);
    ASSERT_TRUE(found.found);
    int count = 0, out_of_front = 0;
    for (std::size_t i = 0; i < matches.first.size(); ++i) {
      const bool within = squaredEpipolarError(found.second_T_first, matches.first[i], matches.second[i]) <
                          one_pixel_rad * one_pixel_rad;
      EXPECT_TRUE(within || !found.inliers[i]) << i;
      out_of_front += within && !found.inliers[i] ? 1 : 0;
      count += found.inliers[i] ? 1 : 0;
    }
    EXPECT_EQ(count, found.inlier_count);
    EXPECT_LE(out_of_front, 4) << "all are in front, but for the noise";
  }
}

// Matches that meet the epipolar constraint with their rays meeting behind the cameras are none, unless the rays are
// parallel within two thresholds: then noise may have crossed them.
TEST(EpipolarRefinement, RaysThatMeetBehindTheCamerasDoNotCount) {
  int behind_and_refused = 0, nearly_parallel = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    NoisyMatches matches = noisyMatches(seed, 120, 0);
    const std::size_t good = matches.first.size();
    // Points behind, near and far: both of their bearings turned about.
    Random random(100 + seed);
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d behind = random.uniform(4, 300) * Eigen::Vector3d(random.uniform(-0.3, 0.3), 0.2, -1);
      matches.first.push_back(-behind.normalized());
      matches.second.push_back(-(matches.second_T_first * behind).normalized());
    }
    const RelativePose found = relativePose(matches.first, matches.second, one_pixel_rad, seed);
    ASSERT_TRUE(found.found);
    for (std::size_t i = 0; i < matches.first.size(); ++i) {
      const double apart = angleBetween(found.second_T_first.rotation * matches.first[i], matches.second[i]);
      if (std::abs(apart - 2 * one_pixel_rad) < 0.05 * one_pixel_rad) continue;
      const bool parallel = apart < 2 * one_pixel_rad;
      EXPECT_EQ(found.inliers[i] != 0, i < good || parallel) << seed << " " << i;
      behind_and_refused += i >= good && !parallel && apart < 4 * one_pixel_rad ? 1 : 0;
      nearly_parallel += i >= good && parallel ? 1 : 0;
    }
  }
  EXPECT_GT(behind_and_refused, 20);
  EXPECT_GT(nearly_parallel, 20);
}

}  // namespace
}  // namespace edgeslam
