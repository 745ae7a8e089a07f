// What an inertial unit measures, and what is known of the unit.
#pragma once

#include <cstdint>

#include "geometry/pose.h"

namespace edgeslam {

struct InertialSample {
  std::int64_t time_ns = 0;                         // the unit's clock
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();   // of turning, the unit's frame [rad/s]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // specific force, the unit's frame [m/s^2]: at rest 9.81 upwards
};

inline std::int64_t timeOf(const InertialSample& sample) { return sample.time_ns; }

// What is to be taken off what is measured.
struct InertialBias {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();   // [rad/s]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // [m/s^2]
};

// Noise as densities, as Kalibr and data sheets give it.
struct InertialUnit {
  Pose imu_T_camera;            // [m]
  double rate_noise = 2e-3;     // [rad/s/sqrt(Hz)]
  double rate_walk = 2e-5;      // of the bias [rad/s^2/sqrt(Hz)]
  double force_noise = 2e-2;    // [m/s^2/sqrt(Hz)]
  double force_walk = 2e-3;     // of the bias [m/s^3/sqrt(Hz)]
  double camera_readout_s = 0;  // as Camera::readout_s, where it was found with the unit; 0: it was not
  std::int64_t offset_ns = 0;   // a frame of the camera's time t was taken at t + offset_ns of the unit's clock
};

constexpr double standard_gravity = 9.80665;  // [m/s^2]

}  // namespace edgeslam
