#include "configuration/configuration.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "configuration/configuration_camera.h"
#include "configuration/configuration_capture.h"
#include "configuration/configuration_checks.h"
#include "configuration/configuration_document.h"
#include "configuration/configuration_imu.h"
#include "configuration/configuration_keys.h"
#include "files/format_text.h"
#include "files/key_suggestion.h"
#include "frames/mask_file.h"
#include "geometry/angles.h"
#include "geometry/distortion_reach.h"

namespace edgeslam {
namespace {

constexpr std::size_t largest_file = 1 << 20;  // [bytes]
constexpr char include_key[] = "include";

std::string readText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be opened");
  std::string text;
  std::array<char, 4096> block{};
  while (file && text.size() <= largest_file) {
    file.read(block.data(), block.size());
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad() || (text.empty() && !file.eof())) throw InputError(path + ": cannot be read (a folder?)");
  if (text.size() > largest_file) throw InputError(path + ": over 1 MiB, so it is no configuration");
  return text;
}

// Reads one file's document; all that is wrong goes to `problems`.
class Reader {
 public:
  Reader(Configuration& configuration, std::vector<ConfigurationProblem>& problems)
      : configuration_(configuration), problems_(problems), keys_(configurationKeys(configuration)) {}

  void readDocument(const YAML::Node& document) {
    if (document.IsNull()) return;
    if (!document.IsMap()) return tell(document.Mark().line, "a mapping of sections is expected here");
    if (isCalibration(document)) {
      return tell(-1, "is a camera's calibration; a configuration names it by camera.calibration");
    }
    forEachKey(document, "", [this](const std::string& name, const YAML::Node& key, const YAML::Node& value) {
      if (name == include_key) return;  // read before
      if (!find(name)) return tellUnknown(key.Mark().line, name);
      readSection(name, key.Mark().line, value);
    });
  }

 private:
  void tell(int line, const std::string& problem) { problems_.push_back({line, problem}); }

  // A key, or a section's heading.
  const ConfigurationKey* find(const std::string& path) const {
    const auto key = std::find_if(keys_.begin(), keys_.end(), [&](const auto& known) { return known.path == path; });
    return key == keys_.end() ? nullptr : &*key;
  }

  void tellUnknown(int line, const std::string& name) {
    const bool is_section = name.find('.') == std::string::npos;
    std::vector<std::string> candidates;
    for (const ConfigurationKey& key : keys_) {
      if (is_section || !key.isHeading()) candidates.push_back(key.path);
    }
    const std::string meant = closestKey(name, candidates);
    tell(line, name + " is not a key" + (meant.empty() ? "" : "; did you mean " + meant + "?"));
  }

  template <typename Use>
  void forEachKey(const YAML::Node& mapping, const std::string& prefix, const Use& use) {
    std::map<std::string, int> seen;  // line of each name
    for (const auto& entry : mapping) {
      const int line = entry.first.Mark().line;
      if (!entry.first.IsScalar()) {
        tell(line, "a key must be a plain word");
        continue;
      }
      const std::string name = prefix + entry.first.Scalar();
      const auto [first, is_new] = seen.emplace(name, line);
      if (!is_new) {
        tell(line, name + " is given twice; first in line " + std::to_string(first->second + 1));
        continue;
      }
      use(name, entry.first, entry.second);
    }
  }

  void readSection(const std::string& section, int line, const YAML::Node& node) {
    if (node.IsNull()) return;  // all of its keys commented out
    if (!node.IsMap()) return tell(line, section + ": a mapping of keys is expected");
    forEachKey(node, section + ".", [this](const std::string& name, const YAML::Node& key, const YAML::Node& value) {
      readKey(name, key.Mark().line, value);
    });
    const TellProblem tell_at = [this](int at, const std::string& problem) { tell(at, problem); };
    if (section == "camera") readCameraSection(node, configuration_, tell_at);
    if (section == "imu") readImuSection(node, configuration_, tell_at);
    if (section == "capture") readCaptureSection(node, configuration_.capture, tell_at);
    const std::string wrong = sectionProblem(section, configuration_);
    if (!wrong.empty()) tell(node.Mark().line, wrong);
  }

  void readKey(const std::string& path, int line, const YAML::Node& value) {
    const ConfigurationKey* key = find(path);
    if (!key) return tellUnknown(line, path);
    if (!key->hasField()) return;  // its section's reader takes it
    if (std::holds_alternative<std::string*>(key->field)) {
      const std::string wrong = value.IsScalar() ? setValue(*key, value.Scalar()) : "a text is expected";
      if (!wrong.empty()) tell(line, path + ": " + wrong);
      return;
    }
    std::string wrong;
    if (!value.IsScalar()) {
      wrong = value.IsNull() ? "has no value" : "a list or mapping";
    } else if (value.Tag() != "?") {  // quoted, or marked as of another type
      wrong = "\"" + value.Scalar() + "\" is a text";
    } else {
      wrong = setValue(*key, value.Scalar());
    }
    if (!wrong.empty()) tell(line, path + ": " + wrong + "; expected " + expectedValue(*key));
  }

  Configuration& configuration_;
  std::vector<ConfigurationProblem>& problems_;
  std::vector<ConfigurationKey> keys_;
};

std::string asLine(const ConfigurationProblem& problem, const std::string& path) {
  const std::string line = problem.line < 0 ? "" : ":" + std::to_string(problem.line + 1);
  return InputError::oneLine(path + line + ": " + problem.text);
}

void readFile(const std::string& path, bool may_include, Configuration& configuration,
              std::vector<std::string>& problems);

// What is wrong with the key itself; of the file it names, to `problems`.
std::optional<ConfigurationProblem> readIncluded(const YAML::Node& node, bool may_include, const std::string& path,
                                                 Configuration& configuration, std::vector<std::string>& problems) {
  const int line = node.Mark().line;
  if (!may_include) return ConfigurationProblem{line, "include: an included file includes no other"};
  if (!node.IsScalar() || node.Scalar().empty())
    return ConfigurationProblem{line, "include: the path of a file is expected"};
  const std::filesystem::path included = std::filesystem::path(path).parent_path() / node.Scalar();
  std::error_code error;
  if (std::filesystem::exists(included, error) && !std::filesystem::is_regular_file(included, error)) {
    return ConfigurationProblem{line, "include: " + node.Scalar() + " is no file"};  // a pipe would be waited for
  }
  readFile(included.string(), false, configuration, problems);
  return std::nullopt;
}

void readDocuments(const std::string& path, bool may_include, Configuration& configuration,
                   std::vector<ConfigurationProblem>& found, std::vector<std::string>& problems) {
  try {
    const std::string text = readText(path);
    if (const auto second = secondDocument(text)) found.push_back(*second);
    const YAML::Node document = YAML::Load(text);
    if (document.IsMap() && document[include_key]) {
      const auto wrong = readIncluded(document[include_key], may_include, path, configuration, problems);
      if (wrong) found.push_back(*wrong);
    }
    configuration.source = path;
    Reader(configuration, found).readDocument(document);
  } catch (const YAML::Exception& error) {
    found.push_back({error.mark.line, "is not YAML: " + error.msg});
  }
}

// Over what the configuration has already.
void readFile(const std::string& path, bool may_include, Configuration& configuration,
              std::vector<std::string>& problems) {
  configuration.source = path;
  std::vector<ConfigurationProblem> found;
  try {
    readDocuments(path, may_include, configuration, found, problems);
  } catch (const InputError& error) {
    problems.emplace_back(error.what());
    return;
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const ConfigurationProblem& a, const ConfigurationProblem& b) { return a.line < b.line; });
  for (const ConfigurationProblem& problem : found) problems.push_back(asLine(problem, path));
}

}  // namespace

std::string presumedLens(const Configuration& configuration) {
  if (!configuration.camera || !configuration.settings.mapping.camera_finding.lens_is_presumed) return "";
  const Camera& camera = *configuration.camera;
  const double half_view = std::atan(0.5 * std::max(camera.width, camera.height) / camera.fx);
  const std::string named = configuration.source.empty() ? "" : configuration.source + ": ";
  return formatted(
      "%sonly the camera's size is known: a focal length of %.0f px is presumed (%.0f degrees are seen), "
      "and looked for; poses bend until it is found",
      named.c_str(), camera.fx, degrees(2 * half_view));
}

std::string doubtfulDistortion(const Camera& camera) {
  if (reachesCorners(camera)) return "";
  return formatted(
      "the distortion of the calibration cannot be right farther than %.0f pixels from the centre, and the farthest "
      "corner is at %.0f: a guess takes its place; calibrate with views of the board in the corners of the image",
      seenAtReach(camera) * camera.fx, farthestCorner(camera) * camera.fx);
}

std::string maskProblem(const Camera& camera, const Configuration& configuration) {
  const std::string wrong = configuration.mask ? maskSizeProblem(*configuration.mask, camera) : "";
  return wrong.empty() ? "" : "camera.mask: " + configuration.mask_path + " " + wrong;
}

Camera asConfigured(Camera camera, const Configuration& configuration) {
  const std::string wrong = maskProblem(camera, configuration);
  if (!wrong.empty()) throw InputError(configuration.source + ": " + wrong);
  camera.readout_s = configuration.readout_s.value_or(camera.readout_s);
  camera.mask = configuration.mask;
  camera = withBelievableDistortion(camera);
  camera.distortion_reach = distortionReach(camera);
  return camera;
}

Camera withReadoutOfUnit(Camera camera, const Configuration& configuration) {
  const InertiaConfiguration& inertia = configuration.inertia;
  if (inertia.is_used && !configuration.has_readout && camera.readout_s == 0) {
    camera.readout_s = inertia.unit.camera_readout_s;
  }
  return camera;
}

Settings settingsWithSensors(const Configuration& configuration) {
  Settings settings = configuration.settings;
  if (settings.wheels.enabled) useWheels({configuration.body_T_camera, settings.wheels.planar}, settings);
  if (!configuration.inertia.is_used) return settings;
  if (!configuration.inertia.has_unit) {
    throw InputError(configuration.source +
                     ": imu.enabled: it is not known where the unit sits; give imu.imu_T_camera or imu.calibration");
  }
  useInertia(configuration.inertia.unit, settings);
  return settings;
}

Configuration readConfiguration(const std::string& path, std::vector<std::string>& problems) {
  Configuration configuration;
  readFile(path, true, configuration, problems);
  return configuration;
}

Configuration readConfiguration(const std::string& path) {
  std::vector<std::string> problems;
  Configuration configuration = readConfiguration(path, problems);
  if (problems.empty()) return configuration;
  if (problems.size() == 1) throw InputError(problems.front());
  throw InputError(problems.front() + " (the first of " + std::to_string(problems.size()) +
                   " problems; `edgeslam check-config` lists them)");
}

bool isCalibrationFile(const std::string& path) {
  try {
    return isCalibration(YAML::Load(readText(path)));
  } catch (const YAML::Exception&) {
    return false;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace edgeslam
