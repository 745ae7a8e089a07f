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

std::string withSigma(const Eigen::Vector3d& value, const Eigen::Vector3d& sigma, int decimals) {
  return formatted("%.*f %.*f %.*f +- %.*f %.*f %.*f", decimals, value.x(), decimals, value.y(), decimals, value.z(),
                   decimals, sigma.x(), decimals, sigma.y(), decimals, sigma.z());
}

std::string rateBiasText(const TurnFit& fit) {
  return withSigma(fit.parameters.rate_bias, biasSigma(fit), 5) + " rad/s";
}

bool tellsForceBias(const InertialCalibration& calibration) {
  return calibration.forces && calibration.forces->tells_bias;
}

bool tellsPlace(const InertialCalibration& calibration) {
  return calibration.forces && calibration.forces->tells_place;
}

std::string forceBiasText(const InertialCalibration& calibration) {
  if (!tellsForceBias(calibration)) return "not told: turn and move the camera more";
  return withSigma(calibration.forces->bias, calibration.forces->bias_sigma, 3) + " m/s^2";
}

std::string placeText(const InertialCalibration& calibration) {
  return withSigma(calibration.forces->imu_t_camera, calibration.forces->imu_t_camera_sigma, 3) + " m";
}

// Where it was given, that was measured, or found with better means.
Eigen::Vector3d placeToWrite(const KnownUnit& known, const InertialCalibration& calibration) {
  if (known.has_place) return known.unit.imu_T_camera.translation;
  return tellsPlace(calibration) ? calibration.forces->imu_t_camera : Eigen::Vector3d(0, 0, 0);
}

std::string placeRemark(const KnownUnit& known, const InertialCalibration& calibration) {
  if (known.has_place) return "is the one given";
  return tellsPlace(calibration) ? "was found" : "was not given and is not told: measure it";
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

std::string inertialUnitText(const KnownUnit& known, const InertialCalibration& calibration,
                             const std::string& source) {
  const TurnFit& fit = calibration.fit;
  const InertialUnit unit = unitWith(known.unit, fit.parameters);
  const Eigen::Vector3d t = placeToWrite(known, calibration);
  std::string text = "# made by edgeslam calibrate --imu from " + InputError::oneLine(source) + "\n";
  text += formatted("# %.1f s, a turn of %.1f s differs by %.4f degrees\n", fit.seconds, calibration.turn_s,
                    degrees(fit.error_rad));
  text += "# the gyroscope's bias: " + rateBiasText(fit) + "; a run finds both biases by itself\n";
  text += "# the accelerometer's bias: " + forceBiasText(calibration) + "\n";
  text += "# the quaternion (w x y z): standard deviation " + rotationSigmaText(fit) + "\n";
  text += "# the translation [m] " + placeRemark(known, calibration) + "\n";
  if (tellsPlace(calibration)) text += "# it was found to be " + placeText(calibration) + "\n";
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
  text += "  rotation              " + quaternionText(fit.parameters.imu_R_camera) + " (imu_T_camera, w x y z), " +
          differenceText(known, fit) + "\n";
  text += "                        +- " + rotationSigmaText(fit) + "\n";
  text += formatted("  time offset           %.2f ms +- %.2f; given: %.2f\n", 1e3 * fit.parameters.offset_s,
                    1e3 * offsetSigma(fit), 1e-6 * static_cast<double>(known.unit.offset_ns));
  text += "  gyroscope's bias      " + rateBiasText(fit) + "\n";
  text += "  accelerometer's bias  " + forceBiasText(calibration) + "\n";
  if (tellsPlace(calibration)) text += "  translation           " + placeText(calibration) + "\n";
  if (!calibration.unchecked.empty()) text += "  " + calibration.unchecked + "\n";
  return text;
}

}  // namespace edgeslam
