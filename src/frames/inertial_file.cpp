#include "frames/inertial_file.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "edgeslam/input_error.h"
#include "files/text_file.h"
#include "frames/yaml_section.h"
#include "geometry/median.h"
#include "inertia/inertial_watch.h"

namespace edgeslam {
namespace {

constexpr double largest_readout_s = 0.2;

std::optional<InertialSample> parseSample(const std::string& text) {
  const std::vector<std::string_view> columns = splitColumns(text);
  const std::optional<std::int64_t> time = columns.size() == 7 ? parseStamp(columns[0]) : std::nullopt;
  if (!time) return std::nullopt;
  std::array<double, 6> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::optional<double> value = parseNumber(columns[i + 1]);
    if (!value) return std::nullopt;
    values[i] = *value;
  }
  InertialSample sample;
  sample.time_ns = *time;
  sample.rate = {values[0], values[1], values[2]};
  sample.force = {values[3], values[4], values[5]};
  return sample;
}

void checkUnits(const std::string& path, const std::vector<InertialSample>& samples) {
  std::vector<double> forces, rates;
  for (const InertialSample& sample : samples) {
    forces.push_back(sample.force.norm());
    rates.push_back(sample.rate.norm());
  }
  const std::string wrong = unitsProblem(upperMedian(std::move(forces)), upperMedian(std::move(rates)));
  if (!wrong.empty()) throw InputError(path + ": " + wrong);
}

Pose readPose(const YamlSection& section, const std::string& key) {
  const YamlSection pose = section.section(key);
  pose.rejectUnknownKeys({"translation", "quaternion"});
  const std::vector<double> translation = pose.numbers("translation"), quaternion = pose.numbers("quaternion");
  pose.expectSize("translation", translation, {3});
  pose.expectSize("quaternion", quaternion, {4});
  const Eigen::Quaterniond rotation(quaternion[0], quaternion[1], quaternion[2], quaternion[3]);
  if (std::abs(rotation.norm() - 1) > 0.01) pose.failAt("quaternion", "'quaternion' (w x y z) must have the length 1");
  return {rotation.normalized(), {translation[0], translation[1], translation[2]}};
}

void readNoise(const YamlSection& section, InertialUnit& unit) {
  const auto read = [&](const char* key, double& value) {
    if (!section.has(key)) return;
    value = section.number(key);
    if (!(value > 0 && value < 100)) section.failAt(key, std::string("'") + key + "' must be greater than 0");
  };
  read("gyroscope_noise_density", unit.rate_noise);
  read("gyroscope_random_walk", unit.rate_walk);
  read("accelerometer_noise_density", unit.force_noise);
  read("accelerometer_random_walk", unit.force_walk);
}

// EuRoC's T_BS: a sensor's frame in the body's.
Pose readEurocPose(const std::string& path) {
  return readYaml(path, "sensor", [](const YamlSection& section) {
    const YamlSection matrix = section.section("T_BS");
    const std::vector<double> data = matrix.numbers("data");
    matrix.expectSize("data", data, {16});
    const Eigen::Matrix4d values = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(data.data());
    const Eigen::Matrix3d rotation = values.topLeftCorner<3, 3>();
    if (!(rotation * rotation.transpose()).isApprox(Eigen::Matrix3d::Identity(), 1e-2)) {
      matrix.failAt("data", "'T_BS' must be a rigid transformation");
    }
    return Pose{Eigen::Quaterniond(rotation).normalized(), values.topRightCorner<3, 1>()};
  });
}

InertialUnit readEurocUnit(const InertialFiles& files) {
  InertialUnit unit;
  readYaml(files.unit, "sensor", [&](const YamlSection& section) { readNoise(section, unit); });
  unit.imu_T_camera = readEurocPose(files.unit).inverse() * readEurocPose(files.euroc_camera);
  return unit;
}

}  // namespace

std::vector<InertialSample> readInertialSamples(const std::string& path) {
  std::vector<InertialSample> samples;
  for (const TextLine& line : readTextLines(path)) {
    const std::optional<InertialSample> sample = parseSample(line.text);
    if (!sample) {
      if (!line.ended && !samples.empty()) break;
      throw InputError(placeInFile(path, line.number) +
                       "expected 7 columns (time [s], rate x y z [rad/s], force x y z [m/s^2]), found '" + line.text +
                       "'");
    }
    if (!samples.empty() && sample->time_ns <= samples.back().time_ns) {
      throw InputError(placeInFile(path, line.number) + "the time stamp is not after the one before");
    }
    samples.push_back(*sample);
  }
  if (samples.empty()) throw InputError(path + ": holds no samples");
  checkUnits(path, samples);
  return samples;
}

InertialUnit readInertialUnit(const std::string& path) {
  return readYaml(path, "inertial unit", [](const YamlSection& section) {
    section.rejectUnknownKeys({"imu_T_camera", "gyroscope_noise_density", "gyroscope_random_walk",
                               "accelerometer_noise_density", "accelerometer_random_walk", "time_offset_s", "readout_s",
                               "rate_hz"});
    InertialUnit unit;
    unit.imu_T_camera = readPose(section, "imu_T_camera");
    readNoise(section, unit);
    if (section.has("time_offset_s")) {
      const double offset_s = section.number("time_offset_s");
      if (std::abs(offset_s) > 10) section.failAt("time_offset_s", "'time_offset_s' must be -10 to 10 seconds");
      unit.offset_ns = static_cast<std::int64_t>(std::llround(offset_s * 1e9));
    }
    if (section.has("readout_s")) {
      unit.camera_readout_s = section.number("readout_s");
      if (std::abs(unit.camera_readout_s) > largest_readout_s) {
        section.failAt("readout_s", "'readout_s' must be -0.2 to 0.2 seconds");
      }
    }
    return unit;
  });
}

std::vector<InertialSample> readInertialSamples(const InertialFiles& files) {
  if (files.samples.empty()) throw InputError("no imu.csv (or EuRoC's imu0) lies beside the frames");
  return readInertialSamples(files.samples);
}

InertialRecording readInertialRecording(const InertialFiles& files) {
  std::vector<InertialSample> samples = readInertialSamples(files);
  if (files.unit.empty()) throw InputError(files.samples + ": no imu.yaml lies beside it, with imu_T_camera");
  return {files.euroc_camera.empty() ? readInertialUnit(files.unit) : readEurocUnit(files), std::move(samples)};
}

}  // namespace edgeslam
