#include "configuration/configuration_camera.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>

#include "configuration/configuration_pose.h"
#include "frames/calibration_file.h"
#include "frames/mask_file.h"

namespace edgeslam {
namespace {

const char* modelName(CameraModel model) {
  return model == CameraModel::kannala_brandt ? "kannala_brandt" : "pinhole_radial_tangential";
}

struct CalibrationKey {
  ConfigurationKey key;
  bool is_needed = true;
};

// The keys of an inline calibration, pointing into `camera`; those of the distortion depend on its model.
std::vector<CalibrationKey> calibrationKeys(Camera& camera) {
  std::array<double, 5>& k = camera.distortion;
  std::vector<CalibrationKey> keys{
      {{"camera.width", &camera.width, "px", 1, largest_camera_side, "image width"}},
      {{"camera.height", &camera.height, "px", 1, largest_camera_side, "image height"}},
      {{"camera.fx", &camera.fx, "px", least_focal_length_px, largest_focal_length_px, "focal length along x"}},
      {{"camera.fy", &camera.fy, "px", least_focal_length_px, largest_focal_length_px, "focal length along y"}},
      {{"camera.cx", &camera.cx, "px", 0, largest_camera_side, "principal point"}},
      {{"camera.cy", &camera.cy, "px", 0, largest_camera_side, "principal point"}},
  };
  const bool fisheye = camera.model == CameraModel::kannala_brandt;
  const std::array<const char*, 5> fisheye_names{"k1", "k2", "k3", "k4", ""};
  const std::array<const char*, 5> radial_tangential_names{"k1", "k2", "p1", "p2", "k3"};
  for (std::size_t i = 0; i < (fisheye ? 4U : 5U); ++i) {
    const std::string name = fisheye ? fisheye_names[i] : radial_tangential_names[i];
    keys.push_back({{"camera." + name, &k[i], "", -largest_distortion, largest_distortion, "distortion"}, false});
  }
  return keys;
}

// What is wrong with the value; empty where it is set.
std::string setNumber(const ConfigurationKey& key, const YAML::Node& value) {
  const std::string wrong = value.IsScalar() ? setValue(key, value.Scalar()) : "not a number";
  return wrong.empty() ? "" : key.path + ": " + wrong + "; expected " + expectedValue(key);
}

// Of the longer side. Most phones, webcams and cameras of robots see 50 to 80 degrees along it.
constexpr double presumed_focal_length = 0.8;

bool hasOnlySize(const YAML::Node& section, const std::vector<CalibrationKey>& keys) {
  if (section["model"] || !section["width"] || !section["height"]) return false;
  return std::none_of(keys.begin() + 2, keys.end(),
                      [&](const CalibrationKey& known) { return static_cast<bool>(section[known.key.name()]); });
}

void readInlineCalibration(const YAML::Node& section, Configuration& configuration, const TellProblem& tell) {
  Camera camera;
  bool good = true;
  const auto reject = [&](const YAML::Node& at, const std::string& problem) {
    tell(at.Mark().line, problem);
    good = false;
  };
  if (const YAML::Node model = section["model"]) {
    const std::string name = model.IsScalar() ? model.Scalar() : "";
    if (name == modelName(CameraModel::kannala_brandt)) {
      camera.model = CameraModel::kannala_brandt;
    } else if (name != modelName(CameraModel::pinhole_radial_tangential)) {
      reject(model, "camera.model: expected pinhole_radial_tangential or kannala_brandt");
    }
  }
  const std::vector<CalibrationKey> keys = calibrationKeys(camera);
  const bool has_only_size = hasOnlySize(section, keys);
  for (const auto& [key, is_needed] : keys) {
    const YAML::Node value = section[key.name()];
    if (!value) {
      if (is_needed && !has_only_size)
        reject(section, key.path + " is missing (" + key.documentation + ", " + expectedValue(key) + ")");
      continue;
    }
    const std::string wrong = setNumber(key, value);
    if (!wrong.empty()) reject(value, wrong);
  }
  for (const char* name : {"p1", "p2", "k4"}) {
    const bool has =
        std::any_of(keys.begin(), keys.end(), [&](const CalibrationKey& known) { return known.key.name() == name; });
    if (section[name] && !has)
      reject(section[name], std::string("camera.") + name + " is no coefficient of this camera model");
  }
  if (!good) return;
  if (has_only_size) camera = presumedCamera(camera.width, camera.height);
  configuration.settings.mapping.camera_finding.lens_is_presumed = has_only_size;
  if (camera.cx < 0 || camera.cx > camera.width - 1 || camera.cy < 0 || camera.cy > camera.height - 1) {
    return tell(section["cx"].Mark().line, "camera.cx, camera.cy: the principal point lies outside the image");
  }
  configuration.camera = camera;
}

void readCalibrationFile(const YAML::Node& section, const YAML::Node& calibration, Configuration& configuration,
                         const TellProblem& tell) {
  if (!calibration.IsScalar() || calibration.Scalar().empty()) {
    return tell(calibration.Mark().line, "camera.calibration: the path of a file is expected");
  }
  for (const auto& entry : section) {
    const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (name == "calibration" || name == "readout" || name == "mask" || name == "body_T_camera") continue;
    tell(entry.first.Mark().line, "camera." + name +
                                      ": the calibration is in a file already (camera.calibration); only "
                                      "camera.readout and camera.mask can be given beside it");
  }
  const std::filesystem::path folder = std::filesystem::path(configuration.source).parent_path();
  try {
    configuration.camera = readCalibration((folder / calibration.Scalar()).string());
    configuration.settings.mapping.camera_finding.lens_is_presumed = false;  // also where an included file presumed it
  } catch (const InputError& error) {
    tell(calibration.Mark().line, std::string("camera.calibration: ") + error.what());
  }
}

void readMaskFile(const YAML::Node& mask, Configuration& configuration, const TellProblem& tell) {
  if (!mask.IsScalar() || mask.Scalar().empty()) {
    return tell(mask.Mark().line, "camera.mask: the path of an image is expected");
  }
  const std::filesystem::path folder = std::filesystem::path(configuration.source).parent_path();
  const std::string path = (folder / mask.Scalar()).string();
  try {
    configuration.mask = readMask(path);
    configuration.mask_path = std::filesystem::absolute(path).lexically_normal().string();
  } catch (const InputError& error) {
    tell(mask.Mark().line, std::string("camera.mask: ") + error.what());
  }
}

void readReadout(const YAML::Node& readout, Configuration& configuration, const TellProblem& tell) {
  double readout_s = 0;
  const ConfigurationKey key{"camera.readout", &readout_s, "s", -longest_readout_s, longest_readout_s};
  if (const std::string wrong = setNumber(key, readout); !wrong.empty()) return tell(readout.Mark().line, wrong);
  configuration.readout_s = readout_s;
}

}  // namespace

bool isCalibration(const YAML::Node& document) {
  const auto has = [&](const char* key) { return static_cast<bool>(document[key]); };
  return document.IsMap() &&
         (has("fx") || has("image_width") || has("camera_matrix") || has("cam0") || has("intrinsics"));
}

std::vector<ConfigurationKey> calibrationKeyNames() {
  struct Shown {
    const char *name, *example, *documentation;  // documented before the first of several that go together
  };
  constexpr std::array<Shown, 13> shown{{
      {"width", "640", "image size [px]"},
      {"height", "480", ""},
      {"fx", "520.9", "focal lengths [px]"},
      {"fy", "521.0", ""},
      {"cx", "325.1", "principal point [px]; the centre of the top-left pixel is (0, 0)"},
      {"cy", "249.7", ""},
      {"k1", "0.2312", "distortion as OpenCV's; a fisheye lens has k1 k2 k3 k4; missing coefficients are 0"},
      {"k2", "-0.7849", ""},
      {"p1", "-0.0033", ""},
      {"p2", "-0.0001", ""},
      {"k3", "0.9172", ""},
      {"k4", "0", ""},
      {"readout", "0.02",
       "of a rolling shutter: from the first row's reading to the last one's [s], negative where they are read from "
       "below;\n0 for a global shutter. Missing, here and in the calibration: found on the way. Also beside "
       "camera.calibration, in place of that of the file"},
  }};
  std::vector<ConfigurationKey> names;
  for (const Shown& key : shown) {
    ConfigurationKey& name = names.emplace_back();
    name.path = std::string("camera.") + key.name;
    name.documentation = key.documentation;
    name.example = key.example;
    name.for_users = true;
  }
  return names;
}

void readCameraSection(const YAML::Node& section, Configuration& configuration, const TellProblem& tell) {
  const YAML::Node calibration = section["calibration"], readout = section["readout"], mask = section["mask"],
                   pose = section["body_T_camera"];
  const bool has_calibration = section.size() > (readout ? 1U : 0U) + (mask ? 1U : 0U) + (pose ? 1U : 0U);
  if (calibration) {
    readCalibrationFile(section, calibration, configuration, tell);
  } else if (has_calibration) {
    readInlineCalibration(section, configuration, tell);
  }
  if (readout) readReadout(readout, configuration, tell);
  if (mask) readMaskFile(mask, configuration, tell);
  const std::string wrong_mask = configuration.camera ? maskProblem(*configuration.camera, configuration) : "";
  if (!wrong_mask.empty()) {
    tell((mask ? mask : section).Mark().line, wrong_mask);
  } else if (configuration.camera) {
    configuration.camera_doubt = doubtfulDistortion(*configuration.camera);
    configuration.camera = asConfigured(*configuration.camera, configuration);
  }
  if (readout || has_calibration) configuration.has_readout = configuration.readout_s.has_value();
  configuration.settings.mapping.camera_finding.readout_is_known = configuration.has_readout;
  // Beside a calibration it is of that one, and not of another that takes its place.
  if (readout && has_calibration) configuration.readout_s.reset();
  if (pose) {
    const std::string wrong = readPose(pose, configuration.body_T_camera);
    if (!wrong.empty()) tell(pose.Mark().line, "camera.body_T_camera: " + wrong);
  }
}

Camera presumedCamera(int width, int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = presumed_focal_length * std::max(width, height);
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  return camera;
}

std::string formatCameraSection(const Configuration& configuration) {
  std::string text = "camera:\n";
  if (configuration.camera) {
    Camera camera = *configuration.camera;
    camera.readout_s = configuration.readout_s.value_or(camera.readout_s);  // also one that was set since
    const bool has_only_size = configuration.settings.mapping.camera_finding.lens_is_presumed;
    if (!has_only_size) text += std::string("  model: ") + modelName(camera.model) + "\n";
    std::vector<CalibrationKey> keys = calibrationKeys(camera);
    if (has_only_size) keys.resize(2);  // width and height
    for (const CalibrationKey& known : keys) {
      text += "  " + known.key.name() + ": " + valueText(known.key.field) + "\n";
    }
    if (camera.readout_s != 0 || configuration.has_readout) {
      text += "  readout: " + numberText(camera.readout_s) + "\n";
    }
  } else if (configuration.readout_s) {
    text += "  readout: " + numberText(*configuration.readout_s) + "\n";
  }
  if (configuration.mask) text += "  mask: " + inQuotes(configuration.mask_path) + "\n";
  text += "  body_T_camera: " + formatPose(configuration.body_T_camera) + "\n";
  return text;
}

}  // namespace edgeslam
