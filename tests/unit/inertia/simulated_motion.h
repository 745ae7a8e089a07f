// A unit that moves smoothly, and what it measures.
#pragma once

#include <cmath>
#include <vector>

#include "inertia/inertial_unit.h"

namespace edgeslam::test {

// Of the unit: how far it swings, and how fast it goes on, in metres and radians.
struct SimulatedMotion {
  double swing_m = 0.4;
  double turn_rad = 0.6;
  Eigen::Vector3d velocity = Eigen::Vector3d(0.1, 0.05, 0);  // [m/s]
  Eigen::Vector3d gravity = Eigen::Vector3d(0, 0, -standard_gravity);

  Pose poseAt(double t) const {
    const Eigen::Vector3d swing(std::sin(1.9 * t), std::cos(1.3 * t), std::sin(2.3 * t + 1));
    const Eigen::Vector3d turn(std::sin(1.1 * t), std::sin(1.7 * t + 0.5), std::cos(0.9 * t));
    return {rotationExp(turn_rad * turn), swing_m * swing + t * velocity};
  }
  Eigen::Vector3d velocityAt(double t) const {
    constexpr double h = 1e-4;
    return (poseAt(t + h).translation - poseAt(t - h).translation) / (2 * h);
  }
  InertialSample measuredAt(double t, const InertialBias& bias = {}) const {
    constexpr double h = 1e-4;
    const Pose before = poseAt(t - h), now = poseAt(t), after = poseAt(t + h);
    InertialSample sample;
    sample.time_ns = std::llround(t * 1e9);
    sample.rate = rotationLog((before.rotation.conjugate() * after.rotation).normalized()) / (2 * h) + bias.rate;
    const Eigen::Vector3d acceleration = (before.translation - 2 * now.translation + after.translation) / (h * h);
    sample.force = now.rotation.conjugate() * (acceleration - gravity) + bias.force;
    return sample;
  }
  // From `from` to `to` [s].
  std::vector<InertialSample> measured(double from, double to, double rate_hz, const InertialBias& bias = {}) const {
    std::vector<InertialSample> samples;
    const int count = static_cast<int>(std::lround((to - from) * rate_hz));
    for (int i = 0; i <= count; ++i) samples.push_back(measuredAt(from + i / rate_hz, bias));
    return samples;
  }
};

}  // namespace edgeslam::test
