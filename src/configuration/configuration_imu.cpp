#include "configuration/configuration_imu.h"

#include <cmath>
#include <filesystem>

#include "configuration/configuration_pose.h"
#include "configuration/configuration_value.h"
#include "frames/inertial_file.h"

namespace edgeslam {
namespace {

void readUnitFile(const YAML::Node& section, const YAML::Node& calibration, Configuration& configuration,
                  const TellProblem& tell) {
  if (!calibration.IsScalar() || calibration.Scalar().empty()) {
    return tell(calibration.Mark().line, "imu.calibration: the path of a file is expected");
  }
  for (const auto& entry : section) {
    const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (name == "calibration" || name == "enabled" || name == "channel") continue;
    tell(entry.first.Mark().line, "imu." + name + ": the unit is in a file already (imu.calibration)");
  }
  const std::filesystem::path folder = std::filesystem::path(configuration.source).parent_path();
  InertiaConfiguration& inertia = configuration.inertia;
  try {
    inertia.unit = readInertialUnit((folder / calibration.Scalar()).string());
    inertia.time_offset_s = static_cast<double>(inertia.unit.offset_ns) * 1e-9;
    inertia.has_unit = true;
  } catch (const InputError& error) {
    tell(calibration.Mark().line, std::string("imu.calibration: ") + error.what());
  }
}

}  // namespace

void readImuSection(const YAML::Node& section, Configuration& configuration, const TellProblem& tell) {
  InertiaConfiguration& inertia = configuration.inertia;
  if (const YAML::Node calibration = section["calibration"]) {
    readUnitFile(section, calibration, configuration, tell);
  } else if (const YAML::Node pose = section["imu_T_camera"]) {
    const std::string wrong = readPose(pose, inertia.unit.imu_T_camera);
    if (!wrong.empty()) tell(pose.Mark().line, "imu.imu_T_camera: " + wrong);
    inertia.has_unit = wrong.empty();
  }
  inertia.unit.offset_ns = static_cast<std::int64_t>(std::llround(inertia.time_offset_s * 1e9));
}

std::string formatImuSection(const InertiaConfiguration& inertia) {
  if (!inertia.is_used && !inertia.has_unit) return "";
  const InertialUnit& unit = inertia.unit;
  std::string text = std::string("imu:\n  enabled: ") + (inertia.is_used ? "true" : "false") +
                     "\n  channel: " + inQuotes(inertia.channel) + "\n";
  if (inertia.has_unit) text += "  imu_T_camera: " + formatPose(unit.imu_T_camera) + "\n";
  return text + "  gyroscope_noise_density: " + numberText(unit.rate_noise) +
         "\n  gyroscope_random_walk: " + numberText(unit.rate_walk) +
         "\n  accelerometer_noise_density: " + numberText(unit.force_noise) +
         "\n  accelerometer_random_walk: " + numberText(unit.force_walk) +
         "\n  time_offset_s: " + numberText(static_cast<double>(unit.offset_ns) * 1e-9) + "\n";
}

}  // namespace edgeslam
