// A camera that turns and moves to and fro, and what an inertial unit on it measures.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "geometry/angles.h"
#include "inertia/camera_turns.h"
#include "inertia/inertial_unit.h"

namespace edgeslam::test {

struct TurningCamera {
  Eigen::Vector3d swing_rad = Eigen::Vector3d(0.25, 0.3, 0.2);  // about the camera's axes
  double pace = 1;                                              // of turning
  Eigen::Vector3d steady_rate = Eigen::Vector3d::Zero();        // that it turns with besides [rad/s]
  double seconds = 20;
  double frame_rate_hz = 30, sample_rate_hz = 200;
  double pose_noise_rad = 3e-4, rate_noise = 2e-4, rate_walk = 2e-5;  // as InertialUnit's
  Eigen::Quaterniond imu_R_camera = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5) * rotationExp({0.05, -0.03, 0.08});
  Eigen::Vector3d rate_bias = Eigen::Vector3d(0.01, -0.02, 0.005);
  double offset_s = 0.037;
  Eigen::Vector3d swing_m = Eigen::Vector3d(0.15, 0.1, 0.2);
  double metres_a_unit = 2.5;  // of the map in which its poses are
  double place_noise_m = 1e-3, force_noise = 2e-3;
  Eigen::Vector3d imu_t_camera = Eigen::Vector3d(0.03, -0.02, 0.05);
  Eigen::Vector3d force_bias = Eigen::Vector3d(0.1, -0.05, 0.08);  // [m/s^2]

  Eigen::Quaterniond orientationAt(double time_s) const {
    const double phase = pace * time_s;
    const Eigen::Vector3d turned(std::sin(3.1 * phase), std::sin(2.3 * phase + 1), std::sin(4.3 * phase + 2));
    return rotationExp(time_s * steady_rate) * rotationExp(swing_rad.cwiseProduct(turned));
  }
  // Of the camera, its own frame [rad/s].
  Eigen::Vector3d rateAt(double time_s) const {
    constexpr double h = 1e-4;
    return rotationLog((orientationAt(time_s - h).conjugate() * orientationAt(time_s + h)).normalized()) / (2 * h);
  }
  Pose cameraAt(double time_s) const {
    const Eigen::Vector3d moved(std::sin(2.7 * time_s + 2), std::sin(3.7 * time_s), std::sin(1.9 * time_s + 1));
    return {orientationAt(time_s), swing_m.cwiseProduct(moved)};
  }
  // What the accelerometer feels without noise and bias [m/s^2].
  Eigen::Vector3d forceAt(double time_s) const {
    constexpr double h = 1e-3;
    const Pose camera_T_imu = Pose{imu_R_camera, imu_t_camera}.inverse();
    const auto unitAt = [&](double at_s) { return cameraAt(at_s) * camera_T_imu; };
    const Eigen::Vector3d acceleration =
        (unitAt(time_s - h).translation - 2 * unitAt(time_s).translation + unitAt(time_s + h).translation) / (h * h);
    return unitAt(time_s).rotation.conjugate() * (acceleration + Eigen::Vector3d(0, 0, standard_gravity));
  }
  std::vector<PosedCamera> poses(unsigned seed) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto noise = [&](double sigma) {
      return Eigen::Vector3d(sigma * normal(random), sigma * normal(random), sigma * normal(random));
    };
    std::vector<PosedCamera> poses;
    for (int i = 0; i < seconds * frame_rate_hz; ++i) {
      PosedCamera posed;
      posed.time_ns = std::llround(1e9 * (100 + i / frame_rate_hz));
      const Pose exact = cameraAt(i / frame_rate_hz);
      posed.world_T_camera = {exact.rotation * rotationExp(noise(pose_noise_rad)),
                              (exact.translation + noise(place_noise_m)) / metres_a_unit};
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
      sample.force = forceAt(time_s) + force_bias + noise(force_noise * std::sqrt(sample_rate_hz));
      walked += noise(rate_walk / std::sqrt(sample_rate_hz));
      samples.push_back(sample);
    }
    return samples;
  }
};

}  // namespace edgeslam::test
