// Random bundle problems whose solution is known.
#pragma once

#include <algorithm>

#include "adjustment/bundle_adjustment.h"
#include "unit/adjustment/synthetic_scene.h"

namespace edgeslam::test {

constexpr double test_huber = 2;  // bound of whitened residuals beyond which they count less

struct BundleScene {
  Camera camera;
  BundleProblem truth;  // observations without noise
};

struct BundleSceneOptions {
  int cameras = 6;
  int fixed = 2;
  int points = 150;
  double sigma_normal = 0.5;
  double sigma_tangent = 0.5;
  double noise = 0;
  CameraModel model = CameraModel::pinhole_radial_tangential;
};

// Cameras on a line of 1 unit, points at 1.5 to 6 units, each hosted by one camera and seen by all others that can, at
// least by one.
inline BundleScene makeBundleScene(Random& random, const BundleSceneOptions& options) {
  BundleScene scene;
  scene.camera = testCamera(options.model);
  BundleProblem& problem = scene.truth;
  for (int i = 0; i < options.cameras; ++i) {
    BundleCamera camera;
    camera.world_T_camera = randomPose(random, 0.1, 0.1);
    camera.world_T_camera.translation.x() += static_cast<double>(i) / (options.cameras - 1);
    camera.fixed = i < options.fixed;
    problem.cameras.push_back(camera);
  }
  while (static_cast<int>(problem.points.size()) < options.points) {
    const int index = static_cast<int>(problem.points.size());
    const std::size_t observations_before = problem.observations.size();
    BundlePoint point;
    point.host = index % options.cameras;
    point.host_bearing = bearing(scene.camera, randomPixel(random, scene.camera));
    point.inverse_depth = 1 / uniform(random, 1.5, 6);
    const Eigen::Vector3d world = problem.cameras[static_cast<std::size_t>(point.host)].world_T_camera *
                                  (point.host_bearing / point.inverse_depth);
    for (int c = 0; c < options.cameras; ++c) {
      if (c == point.host) continue;
      const Eigen::Vector3d seen = problem.cameras[static_cast<std::size_t>(c)].world_T_camera.inverse() * world;
      if (!inFront(scene.camera, seen)) continue;
      const Eigen::Vector2d pixel = project(scene.camera, seen);
      if (!insideImage(scene.camera, pixel)) continue;
      BundleObservation o;
      o.camera = c;
      o.point = index;
      o.measurement = measure(random, pixel, uniform(random, -M_PI, M_PI), options.sigma_normal, options.sigma_tangent,
                              options.noise);
      problem.observations.push_back(o);
    }
    if (problem.observations.size() > observations_before) problem.points.push_back(point);
  }
  return scene;
}

// The truth with its free cameras moved and its free points' depths off by up to 20 %.
inline BundleProblem perturbedProblem(Random& random, const BundleProblem& truth, double translation, double rotation) {
  BundleProblem problem = truth;
  for (BundleCamera& c : problem.cameras) {
    if (!c.fixed) c.world_T_camera = perturbed(random, c.world_T_camera, translation, rotation);
  }
  for (BundlePoint& p : problem.points) {
    if (!p.fixed) p.inverse_depth *= uniform(random, 0.8, 1.25);
  }
  return problem;
}

inline double largestTranslationError(const BundleProblem& a, const BundleProblem& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    largest =
        std::max(largest, (a.cameras[i].world_T_camera.translation - b.cameras[i].world_T_camera.translation).norm());
  }
  return largest;
}

inline double largestRotationError(const BundleProblem& a, const BundleProblem& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    largest =
        std::max(largest, rotationAngle(a.cameras[i].world_T_camera.rotation, b.cameras[i].world_T_camera.rotation));
  }
  return largest;
}

inline double largestDepthError(const BundleProblem& a, const BundleProblem& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    largest = std::max(largest, std::abs(a.points[i].inverse_depth - b.points[i].inverse_depth));
  }
  return largest;
}

inline bool sameBytes(const BundleProblem& a, const BundleProblem& b) {
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    if (!sameBytes(a.cameras[i].world_T_camera, b.cameras[i].world_T_camera)) return false;
  }
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    if (a.points[i].inverse_depth != b.points[i].inverse_depth) return false;
  }
  return true;
}

inline BundleOptions manyIterations() {
  BundleOptions options;
  options.iterations = 50;
  return options;
}

}  // namespace edgeslam::test
