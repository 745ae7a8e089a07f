// Seeded random cameras' views of random points, for the geometry tests.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "geometry/camera.h"
#include "geometry/distortion_reach.h"
#include "geometry/pose.h"
#include "unit/geometry/degree.h"

namespace edgeslam {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  double normal(double sigma) { return std::normal_distribution<double>(0, sigma)(engine_); }
  Eigen::Vector3d vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
  Eigen::Vector3d direction() { return Eigen::Vector3d(normal(1), normal(1), normal(1)).normalized(); }
  Eigen::Quaterniond rotation(double angle) { return rotationExp(angle * direction()); }

 private:
  std::mt19937 engine_;
};

inline Camera pinholeCamera() {
  return {CameraModel::pinhole_radial_tangential, 640, 480, 520.9, 521, 325.1, 249.7,
          {0.08, -0.16, -0.0015, -0.0004, 0}};
}

constexpr double one_pixel_rad = 1.0 / 520;  // of that camera, nearly

inline Camera fisheyeCamera() {
  return {CameraModel::kannala_brandt, 512, 512, 190.98, 190.97, 254.93, 256.90, {0.0034, 0.0007, -0.0020, 0.0002, 0}};
}

struct NamedCamera {
  std::string name;
  Camera camera;
};

// The calibrations of the recorded sequences, and a fisheye.
inline std::vector<NamedCamera> cameras() {
  const CameraModel pinhole = CameraModel::pinhole_radial_tangential;
  return {{"desk", pinholeCamera()},
          {"panels", {pinhole, 640, 480, 535.4, 539.2, 320.1, 247.6, {0.045, -0.11, -0.0012, 0.0007, 0}}},
          {"corridor", {pinhole, 640, 480, 421, 421.6, 322.4, 236.8, {-0.245, 0.055, 0.0004, -0.0006, 0}}},
          {"kitchen", {pinhole, 640, 480, 522.124, 522.124, 319.179, 247.402, {-0.028296, 0, 0, 0, 0}}},
          {"office", {pinhole, 640, 480, 481.2, 480, 319.5, 239.5, {0, 0, 0, 0, 0}}},
          {"xyz", {pinhole, 640, 480, 517.3, 516.5, 318.6, 255.3, {0.12, -0.22, -0.0022, 0.0012, 0}}},
          {"fisheye", fisheyeCamera()}};
}

// Calibrations whose distortion cannot be believed in the corners: a phone's, as others have made it with a board that
// was never there, a wide lens's and a fisheye's, which miss a coefficient.
inline std::vector<NamedCamera> foldingCameras() {
  const CameraModel pinhole = CameraModel::pinhole_radial_tangential;
  std::vector<NamedCamera> folding = {
      {"folding_phone", {pinhole, 960, 540, 438.3, 437.9, 494, 263.5, {-0.0213, 0.0593, -0.0004, 0.001, -0.0637}}},
      {"folding_wide", {pinhole, 640, 480, 320, 320, 320, 240, {-0.3, 0.02, 0, 0, 0}}},
      {"folding_fisheye", {CameraModel::kannala_brandt, 640, 480, 240, 240, 320, 240, {-0.1, 0, 0, 0, 0}}}};
  for (NamedCamera& named : folding) named.camera.distortion_reach = distortionReach(named.camera);
  return folding;
}

inline Eigen::Vector2d randomPixel(const Camera& camera, Random& random) {
  return {random.uniform(0, camera.width - 1), random.uniform(0, camera.height - 1)};
}

// How points lie in space.
enum class Structure { volume, plane };

// Angle [rad] between two directions.
inline double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace edgeslam
