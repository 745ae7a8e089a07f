// P16: the camera's pose from points of known place, among outliers and in degenerate sets.
#include "geometry/resectioning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "unit/geometry/scene_fixture.h"

namespace edgeslam {
namespace {

struct Sighting {
  Vectors3 points, bearings;
  std::vector<char> good;
  Pose camera_T_world;
};

Sighting makeSighting(unsigned seed, int count, Structure structure, double noise, double outliers,
                      const Camera& camera = pinholeCamera()) {
  Random random(seed);
  Sighting sighting;
  sighting.camera_T_world = {random.rotation(random.uniform(0, 3)), random.vector(5)};
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d pixel = randomPixel(camera, random);
    const Eigen::Vector3d ray = bearing(camera, pixel);
    const double depth =
        structure == Structure::plane ? 3.0 / Eigen::Vector3d(0.4, -0.3, 1).dot(ray) : random.uniform(1, 6);
    const bool good = i >= outliers * count;
    const Eigen::Vector2d seen = good ? pixel : randomPixel(camera, random);
    sighting.points.push_back(sighting.camera_T_world.inverse() * (depth * ray));
    sighting.bearings.push_back(bearing(camera, seen + Eigen::Vector2d(random.normal(noise), random.normal(noise))));
    sighting.good.push_back(good);
  }
  return sighting;
}

constexpr double two_pixels_rad = 2 * one_pixel_rad;

void expectPose(const ResectioningResult& found, const Sighting& sighting, double rotation_degrees, double centre) {
  ASSERT_TRUE(found.found);
  EXPECT_LT(rotationAngle(found.camera_T_world.rotation, sighting.camera_T_world.rotation), rotation_degrees * degree);
  const Eigen::Vector3d found_centre = found.camera_T_world.inverse().translation;
  EXPECT_LT((found_centre - sighting.camera_T_world.inverse().translation).norm(), centre);
}

TEST(Resection, RecoversExactPose) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    for (const Structure structure : {Structure::volume, Structure::plane}) {
      const Sighting sighting = makeSighting(seed, 50, structure, 0, 0);
      const ResectioningResult found = resection(sighting.points, sighting.bearings, two_pixels_rad, seed);
      expectPose(found, sighting, 1e-4, 1e-5);
      EXPECT_EQ(found.inlier_count, 50);
    }
  }
}

TEST(Resection, RecoversPoseUnderNoiseAndOutliers) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    for (const Structure structure : {Structure::volume, Structure::plane}) {
      const Sighting sighting = makeSighting(seed, 200, structure, 0.5, 0.4);
      const ResectioningResult found = resection(sighting.points, sighting.bearings, two_pixels_rad, seed);
      expectPose(found, sighting, 0.2, 0.02);
      for (std::size_t i = 0; i < sighting.good.size(); ++i) {
        if (!sighting.good[i] && found.inliers[i]) ADD_FAILURE() << "wrong match " << i << " taken";
      }
      EXPECT_GE(found.inlier_count, 117) << "of 120";
      EXPECT_EQ(found.inlier_count, std::accumulate(found.inliers.begin(), found.inliers.end(), 0));
    }
  }
}

TEST(Resection, RecoversFisheyePose) {
  const Sighting sighting = makeSighting(3, 200, Structure::volume, 0.2, 0.3, fisheyeCamera());
  const ResectioningResult found = resection(sighting.points, sighting.bearings, 1.0 / 190, 1);
  expectPose(found, sighting, 0.2, 0.02);
  EXPECT_GE(found.inlier_count, 137) << "of 140: those outside the normalized plane count as well";
}

TEST(Resection, AnswersDegenerateInputWithoutThrowing) {
  const Sighting sighting = makeSighting(4, 20, Structure::volume, 0.1, 0);
  for (const long count : {0, 1, 3, 4, 5}) {
    const Vectors3 points(sighting.points.begin(), sighting.points.begin() + count);
    const Vectors3 bearings(sighting.bearings.begin(), sighting.bearings.begin() + count);
    EXPECT_FALSE(resection(points, bearings, two_pixels_rad, 1).found) << count;
  }
  const Vectors3 one_place(20, Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(resection(one_place, Vectors3(20, Eigen::Vector3d::UnitZ()), two_pixels_rad, 1).found);
  EXPECT_FALSE(resection(one_place, sighting.bearings, two_pixels_rad, 1).found);
  Vectors3 line, line_bearings;
  for (int i = 0; i < 20; ++i) {
    line.emplace_back(0.1 * i - 1, 0.05 * i, 3 + 0.1 * i);
    line_bearings.push_back(line.back().normalized());
  }
  EXPECT_FALSE(resection(line, line_bearings, two_pixels_rad, 1).found) << "points on a line";
  const Sighting wrong = makeSighting(5, 60, Structure::volume, 0, 1);
  EXPECT_LT(resection(wrong.points, wrong.bearings, two_pixels_rad, 1).inlier_count, 10) << "all matches wrong";
}

TEST(Resection, IsAFunctionOfItsSeed) {
  const Sighting sighting = makeSighting(6, 100, Structure::volume, 0.5, 0.5);
  const ResectioningResult a = resection(sighting.points, sighting.bearings, two_pixels_rad, 3);
  const ResectioningResult b = resection(sighting.points, sighting.bearings, two_pixels_rad, 3);
  EXPECT_EQ(a.camera_T_world.rotation.coeffs(), b.camera_T_world.rotation.coeffs());
  EXPECT_EQ(a.camera_T_world.translation, b.camera_T_world.translation);
  EXPECT_EQ(a.inliers, b.inliers);
}

}  // namespace
}  // namespace edgeslam
