// Seeded random cameras, points and edge measurements for the tests of the adjustments.
#pragma once

#include <random>

#include "adjustment/reprojection.h"
#include "geometry/camera.h"
#include "geometry/measurement.h"
#include "geometry/pose.h"

namespace edgeslam::test {

using Random = std::mt19937_64;

inline double uniform(Random& random, double low, double high) {
  // Not std::uniform_real_distribution: its values differ between standard libraries.
  return low + (high - low) * (static_cast<double>(random() >> 11) / 9007199254740992.0);
}

inline double gaussian(Random& random, double sigma) {
  const double a = uniform(random, 1e-300, 1), b = uniform(random, 0, 1);
  return sigma * std::sqrt(-2 * std::log(a)) * std::cos(2 * M_PI * b);
}

inline Eigen::Vector3d uniformVector(Random& random, double size) {
  const double x = uniform(random, -size, size), y = uniform(random, -size, size);
  return {x, y, uniform(random, -size, size)};
}

inline Eigen::Vector3d direction(Random& random) {
  const Eigen::Vector3d v(gaussian(random, 1), gaussian(random, 1), gaussian(random, 1));
  return v.normalized();
}

inline Camera testCamera(CameraModel model) {
  Camera camera;
  camera.model = model;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 410;
  camera.fy = 405;
  camera.cx = 322;
  camera.cy = 238;
  if (model == CameraModel::pinhole_radial_tangential) {
    camera.distortion = {-0.12, 0.03, 0.001, -0.0007, 0.002};
  } else {
    camera.distortion = {-0.02, 0.004, -0.001, 0.0003, 0};
  }
  return camera;
}

inline const Camera distorted_camera = testCamera(CameraModel::pinhole_radial_tangential);

inline Pose randomPose(Random& random, double translation, double rotation) {
  Pose pose;
  pose.translation = uniformVector(random, translation);
  pose.rotation = rotationExp(uniform(random, 0, rotation) * direction(random));
  return pose;
}

// A pose moved by exactly these distances in random directions.
inline Pose perturbed(Random& random, const Pose& pose, double translation, double rotation) {
  Vector6d update;
  update << translation * direction(random), rotation * direction(random);
  return retract(pose, update);
}

inline bool sameBytes(const Pose& a, const Pose& b) {
  return a.rotation.coeffs() == b.rotation.coeffs() && a.translation == b.translation;
}

inline Eigen::Vector2d randomPixel(Random& random, const Camera& camera) {
  const double x = uniform(random, 10, camera.width - 10);
  return {x, uniform(random, 10, camera.height - 10)};
}

// The measurement of a pixel on an edge whose normal is at `angle` [rad], with noise of `noise` times its sigmas. Where
// the position along the edge is as good as unknown (sigma 1000), it is off by up to 3 px, as a sliding track would be.
inline Measurement measure(Random& random, const Eigen::Vector2d& pixel, double angle, double sigma_normal,
                           double sigma_tangent, double noise) {
  Measurement m;
  m.normal = {std::cos(angle), std::sin(angle)};
  m.sigma_normal = sigma_normal;
  m.sigma_tangent = sigma_tangent;
  const Eigen::Vector2d tangent(-m.normal.y(), m.normal.x());
  const double across = gaussian(random, noise * sigma_normal);
  const double along =
      sigma_tangent > 100 ? (noise > 0 ? uniform(random, -3, 3) : 0) : gaussian(random, noise * sigma_tangent);
  m.pixel = pixel + across * m.normal + along * tangent;
  return m;
}

}  // namespace edgeslam::test
