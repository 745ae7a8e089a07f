#include "simulator/inertial_simulation.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "files/format_text.h"
#include "files/text_file.h"

namespace edgeslam {
namespace {

constexpr double after_last_frame_s = 0.05;
constexpr double step_s = 1e-3;  // of the derivatives: what is faster no unit would follow

// Normally distributed, by Box and Muller's method; the same seed gives the same numbers.
class InertialNoise {
 public:
  explicit InertialNoise(std::uint64_t seed) : generator_(seed * 0x9E3779B97F4A7C15U + 0x696E65727469U) {}

  Eigen::Vector3d of(double sigma) { return sigma * Eigen::Vector3d(next(), next(), next()); }

 private:
  double uniform() { return (static_cast<double>(generator_() >> 11U) + 0.5) * 0x1p-53; }
  double next() { return std::sqrt(-2 * std::log(uniform())) * std::cos(2 * M_PI * uniform()); }

  std::mt19937_64 generator_;
};

InertialSample exactSample(const CameraMotion& motion, const Pose& camera_T_imu, double time_s) {
  const double at_s = std::max(time_s, step_s);  // nothing is known of before the start
  const Pose before = poseAt(motion, at_s - step_s) * camera_T_imu, now = poseAt(motion, at_s) * camera_T_imu,
             after = poseAt(motion, at_s + step_s) * camera_T_imu;
  const Eigen::Vector3d acceleration =
      (before.translation - 2 * now.translation + after.translation) / (step_s * step_s);
  const Eigen::Vector3d gravity(0, 0, -standard_gravity);
  InertialSample sample;
  sample.rate = rotationLog((before.rotation.conjugate() * after.rotation).normalized()) / (2 * step_s);
  sample.force = now.rotation.conjugate() * (acceleration - gravity);
  return sample;
}

}  // namespace

InertialUnit simulatedUnit() {
  InertialUnit unit;
  unit.imu_T_camera = {Eigen::Quaterniond(std::sqrt(0.5), 0, 0, std::sqrt(0.5)), {0.03, -0.01, 0.005}};
  unit.rate_noise = 2e-4;
  unit.rate_walk = 2e-5;
  unit.force_noise = 2.5e-3;
  unit.force_walk = 4e-4;
  return unit;
}

std::vector<InertialSample> simulateInertia(const SimulatedSequence& sequence) {
  const InertialUnit unit = simulatedUnit();
  const Pose camera_T_imu = unit.imu_T_camera.inverse();
  const double interval_s = 1 / simulated_inertial_rate_hz;
  const double last_s = static_cast<double>(sequence.time(sequence.size() - 1) - sequence.time(0)) * 1e-9;
  InertialNoise noise(sequence.options.seed);
  InertialBias bias{noise.of(0.01), noise.of(0.1)};
  std::vector<InertialSample> samples;
  for (int i = 0; i * interval_s <= last_s + after_last_frame_s; ++i) {
    InertialSample sample = exactSample(sequence.motion, camera_T_imu, i * interval_s);
    sample.time_ns = sequence.time(0) + std::llround(1e9 * i * interval_s);
    sample.rate += bias.rate + noise.of(unit.rate_noise * std::sqrt(simulated_inertial_rate_hz));
    sample.force += bias.force + noise.of(unit.force_noise * std::sqrt(simulated_inertial_rate_hz));
    bias.rate += noise.of(unit.rate_walk * std::sqrt(interval_s));
    bias.force += noise.of(unit.force_walk * std::sqrt(interval_s));
    samples.push_back(sample);
  }
  return samples;
}

std::string formatInertialUnit(const InertialUnit& unit) {
  const Eigen::Vector3d& t = unit.imu_T_camera.translation;
  const Eigen::Quaterniond& q = unit.imu_T_camera.rotation;
  return formatted("rate_hz: %g\n", simulated_inertial_rate_hz) +
         formatted("imu_T_camera: {translation: [%.9g, %.9g, %.9g], quaternion: [%.9g, %.9g, %.9g, %.9g]}\n", t.x(),
                   t.y(), t.z(), q.w(), q.x(), q.y(), q.z()) +
         formatted("gyroscope_noise_density: %g\ngyroscope_random_walk: %g\n", unit.rate_noise, unit.rate_walk) +
         formatted("accelerometer_noise_density: %g\naccelerometer_random_walk: %g\n", unit.force_noise,
                   unit.force_walk);
}

std::string formatInertialSamples(const std::vector<InertialSample>& samples) {
  std::string text = "# time [s], rate x y z [rad/s], specific force x y z [m/s^2] (gravity included), unit's frame\n";
  for (const InertialSample& sample : samples) {
    text += formatStamp(sample.time_ns);
    for (const Eigen::Vector3d& values : {sample.rate, sample.force}) {
      text += formatted(", %.7f, %.7f, %.7f", values.x(), values.y(), values.z());
    }
    text += "\n";
  }
  return text;
}

}  // namespace edgeslam
