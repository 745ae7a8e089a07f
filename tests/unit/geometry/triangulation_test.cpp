// P17: the depth of a point, its uncertainty, and what has none.
#include "geometry/triangulation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/geometry/scene_fixture.h"

namespace edgeslam {
namespace {

struct Sight {
  Camera camera;
  Eigen::Vector3d host_bearing;
  double inverse_depth = 0;
  std::vector<TriangulationView> views;
};

Measurement cornerMeasurement(const Eigen::Vector2d& pixel, double sigma) {
  return {pixel, Eigen::Vector2d::UnitX(), sigma, sigma};
}

// Pixel of the sight's point in a camera.
Eigen::Vector2d pixelIn(const Sight& sight, const Pose& view_T_host) {
  return project(sight.camera, view_T_host * (sight.host_bearing / sight.inverse_depth));
}

// A point at `depth` [map units], seen as a corner from `views` poses within 0.3 of the host's.
Sight makeSight(Random& random, const Camera& camera, double depth, int views, double sigma = 0.5) {
  Sight sight{camera, bearing(camera, randomPixel(camera, random)), 1 / depth, {}};
  while (static_cast<int>(sight.views.size()) < views) {
    const Pose view_T_host{random.rotation(random.uniform(0, 0.2)), random.vector(0.3)};
    if (sight.host_bearing.cross(view_T_host.inverse().translation).norm() < 0.05) continue;
    const Eigen::Vector3d seen = view_T_host * (sight.host_bearing * depth);
    if (seen.z() < -0.3 * seen.norm() || !insideImage(camera, project(camera, seen))) continue;
    // Far outside the image a polynomial distortion folds back into it, which no real lens does.
    if (angleBetween(bearing(camera, project(camera, seen)), seen) > 1e-6) continue;
    sight.views.push_back({view_T_host, cornerMeasurement(pixelIn(sight, view_T_host), sigma)});
  }
  return sight;
}

// Direction [unit, px] in which the point moves in a view as its depth changes.
Eigen::Vector2d epipolarDirection(const Sight& sight, const Pose& view_T_host) {
  Eigen::Matrix<double, 2, 3> jacobian;
  project(sight.camera, view_T_host * (sight.host_bearing / sight.inverse_depth), &jacobian);
  return (jacobian * view_T_host.translation).normalized();
}

Eigen::Vector2d rotated(const Eigen::Vector2d& v, double angle) { return Eigen::Rotation2Dd(angle) * v; }

TEST(Triangulate, RecoversExactDepth) {
  Random random(1);
  for (const NamedCamera& named : cameras()) {
    for (int i = 0; i < 200; ++i) {
      const Sight sight =
          makeSight(random, named.camera, std::exp(random.uniform(std::log(0.5), std::log(50))), 1 + i % 4);
      const TriangulationResult found = triangulate(sight.camera, sight.host_bearing, sight.views);
      ASSERT_TRUE(found.converged) << named.name << " depth " << 1 / sight.inverse_depth;
      EXPECT_NEAR(found.inverse_depth, sight.inverse_depth, 1e-5 * found.sigma + 1e-12);
      EXPECT_LT(found.largest_error, 1e-4);
      EXPECT_GT(found.sigma, 0);
    }
  }
}

TEST(Triangulate, IsTheSameFromAnyStart) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Sight sight = makeSight(random, pinholeCamera(), random.uniform(1, 10), 3);
    for (const double factor : {0.3, 0.9, 1.5}) {
      const TriangulationResult found =
          triangulate(sight.camera, sight.host_bearing, sight.views, factor * sight.inverse_depth);
      ASSERT_TRUE(found.converged);
      EXPECT_NEAR(found.inverse_depth, sight.inverse_depth, 1e-5 * found.sigma + 1e-12);
    }
  }
}

// An edge point measured anywhere along its edge still gives the depth, as long as the edge crosses the epipolar line.
TEST(Triangulate, RecoversDepthOfAnEdgeWhosePixelSlidesAlongIt) {
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    Camera camera = pinholeCamera();
    camera.distortion.fill(0);  // so that the edge is straight in the image
    Sight sight = makeSight(random, camera, random.uniform(1, 10), 2);
    for (TriangulationView& view : sight.views) {
      const Eigen::Vector2d along = epipolarDirection(sight, view.view_T_host);
      const Eigen::Vector2d normal = rotated(along, random.uniform(-60, 60) * degree);
      view.measurement = {view.measurement.pixel + random.uniform(-20, 20) * rotated(normal, M_PI / 2), normal, 0.5,
                          1e6};
    }
    const TriangulationResult found = triangulate(camera, sight.host_bearing, sight.views);
    ASSERT_TRUE(found.converged);
    EXPECT_NEAR(found.inverse_depth, sight.inverse_depth, 1e-3 * found.sigma);
  }
}

// The gate of P17: sigma grows as 1 / cos of the angle between the epipolar line and the edge's normal.
TEST(Triangulate, SigmaTellsAnEdgeAlongTheEpipolarLine) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    Sight sight = makeSight(random, pinholeCamera(), random.uniform(1, 5), 1);
    Measurement& measurement = sight.views[0].measurement;
    const Eigen::Vector2d along = epipolarDirection(sight, sight.views[0].view_T_host);
    const auto sigmaAt = [&](double angle) {
      measurement.normal = rotated(along, angle);
      measurement.sigma_tangent = 1000;
      return triangulate(sight.camera, sight.host_bearing, sight.views, sight.inverse_depth).sigma;
    };
    const double across = sigmaAt(0);
    EXPECT_NEAR(sigmaAt(60 * degree) / across, 2, 1e-3);
    EXPECT_NEAR(sigmaAt(85 * degree) / across, 1 / std::cos(85 * degree), 0.05);
    EXPECT_GT(sigmaAt(90 * degree) / across, 1000) << "only the tangent's 1000 px are left";
    EXPECT_GT(sigmaAt(90 * degree), 0.15 * sight.inverse_depth) << "what the depth gate refuses";
  }
}

TEST(Triangulate, SigmaIsHonest) {
  Random random(5);
  double sum = 0, sum_squared = 0;
  const int trials = 1000;
  for (int i = 0; i < trials; ++i) {
    Sight sight = makeSight(random, pinholeCamera(), random.uniform(1, 4), 3);
    for (TriangulationView& view : sight.views) {
      const double sigma_normal = random.uniform(0.1, 0.6), sigma_tangent = random.uniform(1, 3) * sigma_normal;
      const Eigen::Vector2d normal = rotated(Eigen::Vector2d::UnitX(), random.uniform(0, 2 * M_PI));
      const Eigen::Vector2d noise =
          random.normal(sigma_normal) * normal + random.normal(sigma_tangent) * rotated(normal, M_PI / 2);
      view.measurement = {view.measurement.pixel + noise, normal, sigma_normal, sigma_tangent};
    }
    const TriangulationResult found = triangulate(sight.camera, sight.host_bearing, sight.views);
    ASSERT_TRUE(found.converged);
    const double error = (found.inverse_depth - sight.inverse_depth) / found.sigma;
    sum += error;
    sum_squared += error * error;
  }
  EXPECT_NEAR(sum / trials, 0, 0.12);
  EXPECT_GT(sum_squared / trials, 0.8);
  EXPECT_LT(sum_squared / trials, 1.2);
}

TEST(Triangulate, ParallaxIsTheLargestAngleBetweenTheRays) {
  const Camera camera = pinholeCamera();
  Sight sight{camera, Eigen::Vector3d::UnitZ(), 0.5, {}};
  for (const double offset : {-0.1, 0.3, 0.2}) {
    const Pose view_T_host{rotationExp({0, 0.05, 0}), rotationExp({0, 0.05, 0}) * Eigen::Vector3d(offset, 0, 0)};
    sight.views.push_back({view_T_host, cornerMeasurement(pixelIn(sight, view_T_host), 0.5)});
  }
  EXPECT_NEAR(triangulate(camera, sight.host_bearing, sight.views).parallax, std::atan2(0.3, 2), 1e-9);
}

TEST(Triangulate, LargestErrorTellsAnOutlierView) {
  Random random(6);
  Sight sight = makeSight(random, pinholeCamera(), 2, 4);
  EXPECT_LT(triangulate(sight.camera, sight.host_bearing, sight.views).largest_error, 1e-4);
  sight.views[2].measurement.pixel += Eigen::Vector2d(20, 20);
  EXPECT_GT(triangulate(sight.camera, sight.host_bearing, sight.views).largest_error, 3);
}

TEST(Triangulate, DoesNotConvergeBehindTheCameraOrBeyondInfinity) {
  Random random(7);
  const Camera camera = pinholeCamera();
  const Pose sideways{Eigen::Quaterniond::Identity(), {-0.3, 0, 0}};
  for (int i = 0; i < 100; ++i) {
    Sight sight{camera, bearing(camera, {random.uniform(200, 400), random.uniform(100, 400)}), 0, {}};
    // The rays part in front of the cameras: they would meet behind.
    Eigen::Vector2d pixel = project(camera, sight.host_bearing);
    pixel.x() += random.uniform(5, 100);
    sight.views.push_back({sideways, cornerMeasurement(pixel, 0.5)});
    EXPECT_FALSE(triangulate(camera, sight.host_bearing, sight.views).converged);
    EXPECT_FALSE(triangulate(camera, sight.host_bearing, sight.views, 0.5).converged);
  }
  // A view that looks the other way can see nothing that the host sees.
  const Pose opposite{rotationExp({0, M_PI, 0}), {0.1, 0, 0}};
  const std::vector<TriangulationView> views{{opposite, cornerMeasurement({320, 240}, 0.5)}};
  EXPECT_FALSE(triangulate(camera, Eigen::Vector3d::UnitZ(), views).converged);
  EXPECT_FALSE(triangulate(camera, Eigen::Vector3d::UnitZ(), views, 1).converged);
}

TEST(Triangulate, RefusesWhatHasNoDepth) {
  const Camera camera = pinholeCamera();
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitZ();
  EXPECT_FALSE(triangulate(camera, ahead, {}).converged);
  const Measurement centre = cornerMeasurement(project(camera, ahead), 0.5);
  const TriangulationResult no_baseline = triangulate(camera, ahead, {{Pose{}, centre}}, 1);
  EXPECT_FALSE(no_baseline.converged);
  EXPECT_TRUE(std::isinf(no_baseline.sigma));
  EXPECT_FALSE(triangulate(camera, ahead, {{Pose{}, centre}}).converged);
  const Pose forward{Eigen::Quaterniond::Identity(), {0, 0, -0.5}};
  EXPECT_FALSE(triangulate(camera, ahead, {{forward, centre}}).converged) << "a point in the direction of motion";
  const Pose sideways{Eigen::Quaterniond::Identity(), {-0.3, 0, 0}};
  const double nan = std::nan("");
  EXPECT_FALSE(triangulate(camera, ahead, {{sideways, cornerMeasurement({nan, 3}, 0.5)}}).converged);
  EXPECT_FALSE(triangulate(camera, {nan, 0, 1}, {{sideways, centre}}).converged);
}

}  // namespace
}  // namespace edgeslam
