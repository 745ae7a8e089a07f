// A camera that turns to and fro, and what an inertial unit on it measures.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "calibration/camera_turns.h"
#include "geometry/angles.h"
#include "inertia/inertial_unit.h"

namespace edgeslam::test {

struct TurningCamera {
  Eigen::Vector3d swing_rad = Eigen::Vector3d(0.25, 0.3, 0.2);  // about the camera's axes
  double seconds = 20;
  double frame_rate_hz = 30, sample_rate_hz = 200;
  double pose_noise_rad = 3e-4, rate_noise = 2e-4, rate_walk = 2e-5;  // as InertialUnit's
  Eigen::Quaterniond imu_R_camera = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5) * rotationExp({0.05, -0.03, 0.08});
  Eigen::Vector3d rate_bias = Eigen::Vector3d(0.01, -0.02, 0.005);
  double offset_s = 0.037;

  Eigen::Quaterniond orientationAt(double time_s) const {
    const Eigen::Vector3d turned(std::sin(3.1 * time_s), std::sin(2.3 * time_s + 1), std::sin(4.3 * time_s + 2));
    return rotationExp(swing_rad.cwiseProduct(turned));
  }
  // Of the camera, its own frame [rad/s].
  Eigen::Vector3d rateAt(double time_s) const {
    constexpr double h = 1e-4;
    return rotationLog((orientationAt(time_s - h).conjugate() * orientationAt(time_s + h)).normalized()) / (2 * h);
  }
  std::vector<PosedCamera> poses(unsigned seed) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, pose_noise_rad);
    std::vector<PosedCamera> poses;
    for (int i = 0; i < seconds * frame_rate_hz; ++i) {
      PosedCamera posed;
      posed.time_ns = std::llround(1e9 * (100 + i / frame_rate_hz));
      posed.world_T_camera.rotation =
          orientationAt(i / frame_rate_hz) * rotationExp({noise(random), noise(random), noise(random)});
      poses.push_back(posed);
    }
    return poses;
  }
  // From before the first frame until after the last one.
  std::vector<InertialSample> samples(unsigned seed) const {
    constexpr double margin_s = 1;
    std::mt19937 random(seed + 1000);
    std::normal_distribution<double> normal;
    const auto noise = [&](double sigma) {
      return Eigen::Vector3d(sigma * normal(random), sigma * normal(random), sigma * normal(random));
    };
    Eigen::Vector3d walked = Eigen::Vector3d::Zero();
    std::vector<InertialSample> samples;
    for (int i = 0; i < (seconds + 2 * margin_s) * sample_rate_hz; ++i) {
      const double time_s = i / sample_rate_hz - margin_s;
      InertialSample sample;
      sample.time_ns = std::llround(1e9 * (100 + time_s + offset_s));
      sample.rate = imu_R_camera * rateAt(time_s) + rate_bias + walked + noise(rate_noise * std::sqrt(sample_rate_hz));
      sample.force = Eigen::Vector3d(0, 0, standard_gravity);
      walked += noise(rate_walk / std::sqrt(sample_rate_hz));
      samples.push_back(sample);
    }
    return samples;
  }
};

}  // namespace edgeslam::test
