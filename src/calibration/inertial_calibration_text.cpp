#include "calibration/inertial_calibration_text.h"

#include <cmath>

#include "edgeslam/input_error.h"
#include "files/format_text.h"
#include "geometry/angles.h"

namespace edgeslam {
namespace {

std::string quaternionText(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1 : 1;
  return formatted("[%.6f, %.6f, %.6f, %.6f]", sign * q.w(), sign * q.x(), sign * q.y(), sign * q.z());
}

std::string rotationSigmaText(const TurnFit& fit) {
  const Eigen::Vector3d sigma = rotationSigma(fit);
  return formatted("%.3f %.3f %.3f degrees about the camera's x, y, z", degrees(sigma.x()), degrees(sigma.y()),
                   degrees(sigma.z()));
}

std::string biasText(const TurnFit& fit) {
  const Eigen::Vector3d& bias = fit.parameters.rate_bias;
  const Eigen::Vector3d sigma = biasSigma(fit);
  return formatted("%.5f %.5f %.5f +- %.5f %.5f %.5f rad/s", bias.x(), bias.y(), bias.z(), sigma.x(), sigma.y(),
                   sigma.z());
}

std::string differenceText(const KnownUnit& known, const TurnFit& fit) {
  if (!known.has_place) return "none was given";
  const Eigen::Quaterniond& before = known.unit.imu_T_camera.rotation;
  return formatted("%.2f degrees from the one given", degrees(rotationAngle(before, fit.parameters.imu_R_camera)));
}

std::string noiseText(const InertialUnit& unit) {
  return formatted("gyroscope_noise_density: %g  # [rad/s/sqrt(Hz)]\n", unit.rate_noise) +
         formatted("gyroscope_random_walk: %g\n", unit.rate_walk) +
         formatted("accelerometer_noise_density: %g  # [m/s^2/sqrt(Hz)]\n", unit.force_noise) +
         formatted("accelerometer_random_walk: %g\n", unit.force_walk);
}

}  // namespace

InertialUnit unitWith(const InertialUnit& known, const InertialCalibration& calibration) {
  InertialUnit unit = known;
  unit.imu_T_camera.rotation = calibration.fit.parameters.imu_R_camera;
  unit.offset_ns = std::llround(calibration.fit.parameters.offset_s * 1e9);
  return unit;
}

std::string inertialUnitText(const KnownUnit& known, const InertialCalibration& calibration,
                             const std::string& source) {
  const TurnFit& fit = calibration.fit;
  const InertialUnit unit = unitWith(known.unit, calibration);
  const Eigen::Vector3d t = known.has_place ? unit.imu_T_camera.translation : Eigen::Vector3d::Zero();
  std::string text = "# made by edgeslam calibrate --imu from " + InputError::oneLine(source) + "\n";
  text += formatted("# %.1f s, a turn of %.1f s differs by %.4f degrees\n", fit.seconds, calibration.turn_s,
                    degrees(fit.error_rad));
  text += "# the gyroscope's bias: " + biasText(fit) + "; a run finds it by itself\n";
  text += "# the quaternion (w x y z): standard deviation " + rotationSigmaText(fit) + "\n";
  text += known.has_place ? "# the translation [m] is the one given\n"
                          : "# the translation [m] was not given and is not found: measure it\n";
  text += formatted("imu_T_camera: {translation: [%.9g, %.9g, %.9g], quaternion: ", t.x(), t.y(), t.z()) +
          quaternionText(unit.imu_T_camera.rotation) + "}\n";
  text += formatted("time_offset_s: %.6f  # standard deviation %.6f\n", fit.parameters.offset_s, offsetSigma(fit));
  if (unit.camera_readout_s != 0) text += formatted("readout_s: %.9g\n", unit.camera_readout_s);
  return text + noiseText(unit);
}

std::string inertialSummary(const KnownUnit& known, const InertialCalibration& calibration) {
  const TurnFit& fit = calibration.fit;
  std::string text = formatted("%.1f s with poses and inertial data, a turn of %.1f s differs by %.3f degrees\n",
                               fit.seconds, calibration.turn_s, degrees(fit.error_rad));
  text += "  rotation          " + quaternionText(fit.parameters.imu_R_camera) + " (w x y z of imu_T_camera), " +
          differenceText(known, fit) + "\n";
  text += "                    +- " + rotationSigmaText(fit) + "\n";
  text += formatted("  time offset       %.2f ms +- %.2f; given: %.2f\n", 1e3 * fit.parameters.offset_s,
                    1e3 * offsetSigma(fit), 1e-6 * static_cast<double>(known.unit.offset_ns));
  text += "  gyroscope's bias  " + biasText(fit) + "\n";
  if (!calibration.unchecked.empty()) text += "  " + calibration.unchecked + "\n";
  return text;
}

}  // namespace edgeslam
