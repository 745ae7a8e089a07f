// P16: the poses that three points and their bearings allow.
#include "geometry/three_point_pose.h"

#include <gtest/gtest.h>

#include <random>

namespace edgeslam {
namespace {

using Triple = std::array<Eigen::Vector3d, 3>;

Eigen::Vector3d randomVector(std::mt19937& random, double reach) {
  std::uniform_real_distribution<double> uniform(-reach, reach);
  return {uniform(random), uniform(random), uniform(random)};
}

struct ThreeSightings {
  Pose camera_T_world;
  Triple points, bearings;
};

ThreeSightings randomSightings(std::mt19937& random) {
  ThreeSightings sighting;
  sighting.camera_T_world = {rotationExp(randomVector(random, 1.5)), randomVector(random, 2)};
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d in_camera = randomVector(random, 1) + Eigen::Vector3d(0, 0, 3);
    sighting.points[i] = sighting.camera_T_world.inverse() * in_camera;
    sighting.bearings[i] = in_camera.normalized();
  }
  return sighting;
}

double largestError(const Pose& pose, const ThreeSightings& sighting) {
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    largest = std::max(largest, ((pose * sighting.points[i]).normalized() - sighting.bearings[i]).norm());
  }
  return largest;
}

TEST(ThreePointPose, TheTruePoseIsAmongThem) {
  std::mt19937 random(1);
  int missed = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const ThreeSightings sighting = randomSightings(random);
    const ThreePointPoses poses = posesFromThreePoints(sighting.points, sighting.bearings);
    double nearest = 1e9;
    for (int i = 0; i < poses.count; ++i) {
      const Pose& pose = poses.camera_T_world[static_cast<std::size_t>(i)];
      nearest = std::min(nearest, (pose.translation - sighting.camera_T_world.translation).norm() +
                                      rotationAngle(pose.rotation, sighting.camera_T_world.rotation));
    }
    if (nearest > 1e-4) ++missed;
  }
  EXPECT_LE(missed, 4) << "of 2000: where two solutions fall together, rounding may lose both";
}

TEST(ThreePointPose, EveryPoseSeesThePointsWhereTheyAre) {
  std::mt19937 random(2);
  int poses_seen = 0, wrong = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const ThreeSightings sighting = randomSightings(random);
    const ThreePointPoses poses = posesFromThreePoints(sighting.points, sighting.bearings);
    for (int i = 0; i < poses.count; ++i) {
      ++poses_seen;
      if (largestError(poses.camera_T_world[static_cast<std::size_t>(i)], sighting) > 1e-4) ++wrong;
    }
  }
  EXPECT_GT(poses_seen, 2000);
  EXPECT_LT(wrong, poses_seen / 100);
}

TEST(ThreePointPose, PointsOnALineOrInOnePlaceGiveNone) {
  const Triple bearings{Eigen::Vector3d::UnitZ(), Eigen::Vector3d(0.1, 0, 1).normalized(),
                        Eigen::Vector3d(0.2, 0, 1).normalized()};
  const Triple line{Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0, 1), Eigen::Vector3d(2, 0, 1)};
  EXPECT_EQ(posesFromThreePoints(line, bearings).count, 0);
  const Triple one_place{Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, 1)};
  EXPECT_EQ(posesFromThreePoints(one_place, bearings).count, 0);
  const Triple not_finite{Eigen::Vector3d(NAN, 0, 1), Eigen::Vector3d(1, 0, 1), Eigen::Vector3d(0, 1, 1)};
  EXPECT_EQ(posesFromThreePoints(not_finite, bearings).count, 0);
}

}  // namespace
}  // namespace edgeslam
