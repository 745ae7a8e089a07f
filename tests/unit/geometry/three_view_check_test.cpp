// P7: the middle view's pixel is held against where the other two views' epipolar lines cross.
#include "geometry/three_view_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/geometry/scene_fixture.h"

namespace edgeslam {
namespace {

struct ThreeViews {
  Camera camera;
  Pose first, middle, last;  // camera to world
  Eigen::Vector2d first_pixel, middle_pixel, last_pixel;

  double error(const Measurement& measurement) const {
    return threeViewError(camera, first, middle, last, first_pixel, measurement, last_pixel);
  }
};

enum class Path { line, triangle };  // of the camera's centre

// A random point seen from three places, on a line (parallel epipolar lines) or not.
ThreeViews makeViews(Random& random, const Camera& camera, Path path) {
  while (true) {
    ThreeViews views;
    views.camera = camera;
    const Pose world_T_start{random.rotation(1), random.vector(3)};
    const Eigen::Vector3d along = random.vector(0.3), aside = path == Path::triangle ? random.vector(0.3) : along;
    views.first = world_T_start;
    views.middle = world_T_start * Pose{random.rotation(0.05), along};
    views.last = world_T_start * Pose{random.rotation(0.05), along + aside};
    const Eigen::Vector2d pixel = randomPixel(camera, random);
    const Eigen::Vector3d point = views.middle * (random.uniform(1, 4) * bearing(camera, pixel));
    const Eigen::Vector3d in_first = views.first.inverse() * point, in_last = views.last.inverse() * point;
    if (in_first.z() < 0.3 || in_last.z() < 0.3) continue;
    views.first_pixel = project(camera, in_first);
    views.middle_pixel = pixel;
    views.last_pixel = project(camera, in_last);
    if (!insideImage(camera, views.first_pixel) || !insideImage(camera, views.last_pixel)) continue;
    // Leave out what no check could tell well: the point near an epipole, lines that hardly cross.
    const Eigen::Vector3d ray = (point - views.middle.translation).normalized();
    const Eigen::Vector3d to_first = (views.first.translation - views.middle.translation).normalized();
    const Eigen::Vector3d to_last = (views.last.translation - views.middle.translation).normalized();
    const Eigen::Vector3d n1 = to_first.cross(ray), n2 = to_last.cross(ray);
    if (n1.norm() < 0.2 || n2.norm() < 0.2) continue;
    const double crossing = n1.cross(n2).norm() / (n1.norm() * n2.norm());
    if (path == Path::triangle ? crossing < 0.2 : crossing > 1e-6) continue;
    return views;
  }
}

Measurement corner(const Eigen::Vector2d& pixel) { return {pixel, Eigen::Vector2d::UnitX(), 0.5, 0.5}; }

TEST(ThreeViewError, IsZeroForATruePoint) {
  Random random(1);
  for (const NamedCamera& named : cameras()) {
    for (int i = 0; i < 50; ++i) {
      const ThreeViews triangle = makeViews(random, named.camera, Path::triangle);
      EXPECT_LT(triangle.error(corner(triangle.middle_pixel)), 1e-5) << named.name;
      const ThreeViews line = makeViews(random, named.camera, Path::line);
      EXPECT_LT(line.error(corner(line.middle_pixel)), 1e-5) << named.name;
    }
  }
}

TEST(ThreeViewError, IsTheWhitenedDistanceFromTheCrossing) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const ThreeViews views = makeViews(random, pinholeCamera(), Path::triangle);
    const Eigen::Vector2d offset(random.uniform(-10, 10), random.uniform(-10, 10));
    EXPECT_NEAR(views.error(corner(views.middle_pixel + offset)), offset.norm() / 0.5, 1e-5);
    const Eigen::Vector2d normal = offset.unitOrthogonal();
    EXPECT_LT(views.error({views.middle_pixel + offset, normal, 0.5, 1000}), 0.02) << "slid along its edge";
  }
}

// On a line of motion the place along the common epipolar line cannot be checked; the distance from it can, in pixels.
TEST(ThreeViewError, IsTheDistanceFromParallelLines) {
  Random random(3);
  for (const Camera& camera : {pinholeCamera(), fisheyeCamera()}) {
    for (int i = 0; i < 100; ++i) {
      const ThreeViews views = makeViews(random, camera, Path::line);
      // The epipolar line's direction in the image, from a neighbouring point in the plane of the motion.
      Eigen::Matrix<double, 2, 3> jacobian;
      const Eigen::Vector3d ray = bearing(camera, views.middle_pixel);
      project(camera, ray, &jacobian);
      const Eigen::Vector3d motion = views.middle.inverse() * views.first.translation;
      const Eigen::Vector2d along = (jacobian * motion).normalized(), across(-along.y(), along.x());
      EXPECT_NEAR(views.error(corner(views.middle_pixel + 0.1 * across)), 0.1 / 0.5, 0.01);
      EXPECT_LT(views.error(corner(views.middle_pixel + 0.1 * along)), 0.01);
      EXPECT_NEAR(views.error({views.middle_pixel + 0.1 * across, across, 0.2, 10}), 0.1 / 0.2, 0.02);
      EXPECT_LT(views.error({views.middle_pixel + 0.1 * across, along, 0.2, 1000}), 0.01) << "slid along its edge";
    }
  }
}

TEST(ThreeViewError, WithoutABaselineTheBearingItselfIsPredicted) {
  Random random(4);
  for (int i = 0; i < 50; ++i) {
    ThreeViews views = makeViews(random, pinholeCamera(), Path::triangle);
    views.first = views.middle * Pose{random.rotation(0.02), Eigen::Vector3d::Zero()};
    views.first_pixel = project(
        views.camera, (views.middle.inverse() * views.first).inverse() * bearing(views.camera, views.middle_pixel));
    EXPECT_LT(views.error(corner(views.middle_pixel)), 1e-5);
    EXPECT_GT(views.error(corner(views.middle_pixel + Eigen::Vector2d(3, 4))), 5 / 0.5 - 1e-5);
    views.last = views.middle;
    views.last_pixel = views.middle_pixel;
    EXPECT_LT(views.error(corner(views.middle_pixel)), 1e-5);
    EXPECT_NEAR(views.error(corner(views.middle_pixel + Eigen::Vector2d(3, 4))), 5 / 0.5, 1e-4);
  }
}

}  // namespace
}  // namespace edgeslam
