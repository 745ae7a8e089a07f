#include "configuration/configuration_service.h"

#include <algorithm>
#include <variant>

#include "configuration/configuration_keys.h"

namespace edgeslam {
namespace {

// A key whose value is a text, pointing into the options. `example`: where the default is empty.
struct TextKey {
  std::string path;
  std::string* text;
  std::string documentation;
  std::string example;
};

using ServiceKey = std::variant<TextKey, ConfigurationKey>;

// In the order of the file.
std::vector<ServiceKey> keysOf(Configuration& configuration) {
  ServiceOptions& options = configuration.service;
  RecordingSpace& space = configuration.settings.recording;
  LcmOptions& lcm = options.lcm;
  ScaleOptions& scale = options.scale;
  ViewerOptions& viewer = options.viewer;
  const auto number = [](const std::string& path, ConfigurationField field, const std::string& unit, double least,
                         double largest, const std::string& documentation) {
    return ConfigurationKey{path, field, unit, least, largest, documentation};
  };
  return {
      TextKey{"lcm.url", &lcm.url, "where messages go (default: LCM_DEFAULT_URL of the environment, or LCM's own)",
              "udpm://239.255.76.67:7667"},
      number("lcm.ttl", &lcm.time_to_live, "", -1, 255,
             "reach of the messages: 0 this computer, 1 the local network; -1: as the URL says"),
      TextKey{"lcm.pose_channel", &lcm.pose_channel, "names of the channels", ""},
      TextKey{"lcm.odometry_channel", &lcm.odometry_channel, "", ""},
      TextKey{"lcm.state_channel", &lcm.state_channel, "", ""},
      TextKey{"lcm.status_channel", &lcm.status_channel, "", ""},
      TextKey{"lcm.map_channel", &lcm.map_channel, "", ""},
      TextKey{"lcm.command_channel", &lcm.command_channel, "", ""},
      TextKey{"lcm.answer_channel", &lcm.answer_channel, "", ""},
      number("lcm.map_interval_s", &options.map_interval_s, "s", 0, 3600,
             "the map is sent at most so often where it changed; 0: on request only"),

      TextKey{"map.file", &options.map_file,
              "written at the end, on SIGHUP and on command, whole or not at all; relative to the working directory",
              "robot.map"},
      number("map.go_on", &options.goes_on_with_map, "", 0, 0,
             "at the start go on with the map in the file, where there is one: frames are looked for in it"),

      TextKey{"recording.folder", &options.recordings_folder,
              "where `edgeslam run` makes a folder for each recording; relative to the working directory",
              "recordings"},
      number("recording.from_start", &options.records_from_start, "", 0, 0,
             "`edgeslam run` records from the start, not only on command"),
      number("recording.most_megabytes", &space.most_megabytes, "MB", 1, 1e9, "most that a recording takes"),
      number("recording.kept_free_megabytes", &space.kept_free_megabytes, "MB", 0, 1e9,
             "left free for others; at less the recording ends"),

      TextKey{"scale.source", &scale.source,
              "none: metres by command only; camera_height: over the ground; odometry: of the wheels, by LCM", ""},
      number("scale.camera_height_m", &scale.height.camera_height_m, "m", 0, 100,
             "of the camera's centre over the ground; 0: not given"),
      number("scale.camera_height_sigma_m", &scale.height.sigma_m, "m", 0, 10, "standard deviation of it"),
      number("scale.ground_tilt_deg", &scale.height.largest_tilt_deg, "deg", 1, 45,
             "largest angle of the ground's normal to the body's z axis (camera.body_T_camera)"),
      TextKey{"scale.odometry_channel", &scale.odometry.channel,
              "of bot_core.pose_t: the body's pose in metres, time stamps of CLOCK_MONOTONIC as the camera's",
              "ODOMETRY"},
      number("scale.odometry_sigma", &scale.odometry.sigma, "", 0, 1,
             "standard deviation of the odometry's own scale (size of the wheels), as a share of it"),
      number("scale.odometry_sigma_per_metre", &scale.odometry.sigma_per_metre, "m", 0.001, 1,
             "of a way of 1 m, by slip; grows with the root of the way"),
      number("scale.odometry_window_m", &scale.odometry.window_m, "m", 0.05, 100,
             "way of the body from one comparison with the camera to the next"),
      number("scale.largest_sigma", &scale.largest_sigma, "", 0.001, 1,
             "a scale is refused where its standard deviation is over this share of it"),
      number("scale.metres_per_unit", &scale.metres_per_unit, "m", 0, 1e6,
             "of the saved map that is gone on with; 0: not known"),
      number("scale.sigma", &scale.sigma, "", 0, 1, "standard deviation of that, as a share of it"),

      number("viewer.enabled", &viewer.enabled, "", 0, 0, "`edgeslam run` serves a page that shows the run"),
      TextKey{"viewer.address", &viewer.address,
              "of this computer, where it is served: 127.0.0.1 to this computer alone (ssh -L brings it to others), "
              "0.0.0.0 to all",
              ""},
      number("viewer.port", &viewer.port, "", 1, 65535, "TCP"),
      TextKey{
          "viewer.token", &viewer.token,
          "who looks on must know it, 16 to 128 letters and digits (openssl rand -hex 16); needed for other addresses",
          "0123456789abcdef0123456789abcdef"},
  };
}

const std::string& pathOf(const ServiceKey& key) {
  return std::visit([](const auto& any) -> const std::string& { return any.path; }, key);
}

std::string sectionOf(const std::string& path) { return path.substr(0, path.find('.')); }
std::string nameOf(const std::string& path) { return path.substr(path.find('.') + 1); }

std::string quoted(const std::string& text) {
  YAML::Emitter emitter;
  emitter << text;
  return emitter.c_str();
}

std::string valueOf(const ServiceKey& key) {
  if (const auto* text = std::get_if<TextKey>(&key)) return quoted(*text->text);
  return valueText(std::get<ConfigurationKey>(key).field);
}

// Empty, or what is wrong.
std::string read(const ServiceKey& key, const YAML::Node& value) {
  const auto* text = std::get_if<TextKey>(&key);
  if (!text) {
    const auto& number = std::get<ConfigurationKey>(key);
    const std::string wrong = value.IsScalar() ? setValue(number, value.Scalar()) : "a list, a mapping or nothing";
    return wrong.empty() ? "" : wrong + "; expected " + expectedValue(number);
  }
  constexpr std::size_t longest = 1000;
  const bool good = value.IsScalar() && !value.Scalar().empty() && value.Scalar().size() <= longest;
  if (good) *text->text = value.Scalar();
  return good ? "" : "a text is expected";
}

// A URL or channel that LCM would not take.
std::string lcmProblem(const LcmOptions& options) {
  try {
    checkChannels(options);
    effectiveUrl(options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// A source that lacks what it needs.
std::string scaleProblem(const ServiceOptions& options) {
  const ScaleOptions& scale = options.scale;
  if (scale.source != "none" && scale.source != "camera_height" && scale.source != "odometry") {
    return "scale.source: '" + scale.source + "' is no source; expected none, camera_height or odometry";
  }
  if (scale.source == "camera_height" && scale.height.camera_height_m <= 0) {
    return "scale.source: camera_height needs scale.camera_height_m";
  }
  if (scale.source != "odometry") return "";
  if (scale.odometry.channel.empty()) return "scale.source: odometry needs scale.odometry_channel";
  LcmOptions lcm = options.lcm;
  if (!lcmProblem(lcm).empty()) return "";  // told of the section `lcm:`
  lcm.wheels_channel = scale.odometry.channel;
  const std::string wrong = lcmProblem(lcm);
  return wrong.empty() ? "" : "scale.odometry_channel: " + wrong;
}

const char* introduction(const std::string& section) {
  if (section == "lcm") return "Messages to the robot's controller";
  if (section == "map") return "The map on the disk, of `edgeslam run`";
  if (section == "recording") return "The flight recorder of live runs";
  if (section == "viewer") return "A page in the browser for people who look on";
  return "Metres a map unit: by command from a known distance, or found by itself";
}

}  // namespace

const std::vector<std::string>& serviceSections() {
  static const std::vector<std::string> sections{"lcm", "map", "recording", "scale", "viewer"};
  return sections;
}

std::vector<std::string> serviceKeys() {
  Configuration configuration;
  std::vector<std::string> names;
  for (const ServiceKey& key : keysOf(configuration)) names.push_back(pathOf(key));
  return names;
}

void readServiceSection(const std::string& section, const YAML::Node& node, Configuration& configuration,
                        const TellProblem& tell) {
  for (const ServiceKey& key : keysOf(configuration)) {
    const std::string& path = pathOf(key);
    if (sectionOf(path) != section) continue;
    const YAML::Node value = node[nameOf(path)];
    if (!value) continue;
    if (const std::string wrong = read(key, value); !wrong.empty()) tell(value.Mark().line, path + ": " + wrong);
  }
  if (section == "lcm") {
    if (const std::string wrong = lcmProblem(configuration.service.lcm); !wrong.empty())
      tell(node.Mark().line, "lcm: " + wrong);
  }
  // The wheels' channel may be in a section before this one, or in an included file.
  const bool is_for_scale = section == "lcm" && configuration.service.scale.source == "odometry";
  if (section == "scale" || is_for_scale) {
    if (const std::string wrong = scaleProblem(configuration.service); !wrong.empty()) tell(node.Mark().line, wrong);
  }
  if (section == "viewer") {
    if (const std::string wrong = viewerProblem(configuration.service.viewer); !wrong.empty()) {
      tell(node.Mark().line, wrong);
    }
  }
}

std::string formatServiceSections(const Configuration& configuration) {
  Configuration shown = configuration, usual;
  const std::vector<ServiceKey> keys = keysOf(shown), usual_keys = keysOf(usual);
  std::string text, section;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::string& path = pathOf(keys[i]);
    if (sectionOf(path) == "viewer") continue;
    if (valueOf(keys[i]) == valueOf(usual_keys[i])) continue;
    if (sectionOf(path) != section) text += sectionOf(path) + ":\n";
    section = sectionOf(path);
    text += "  " + nameOf(path) + ": " + valueOf(keys[i]) + "\n";
  }
  return text;
}

std::string serviceSectionsDocumentation() {
  Configuration usual;
  std::string text, section;
  for (const ServiceKey& key : keysOf(usual)) {
    const std::string& path = pathOf(key);
    if (sectionOf(path) != section) {
      section = sectionOf(path);
      text += std::string("\n# ") + introduction(section) + ".\n" + section + ":\n";
    }
    if (const auto* number = std::get_if<ConfigurationKey>(&key)) {
      text += "  # " + number->documentation + " (" + expectedValue(*number) + ")\n";
      text += "  " + nameOf(path) + ": " + valueOf(key) + "\n";
      continue;
    }
    const TextKey& named = std::get<TextKey>(key);
    if (!named.documentation.empty()) text += "  # " + named.documentation + "\n";
    text += named.text->empty() ? "  # " + nameOf(path) + ": " + named.example + "\n"
                                : "  " + nameOf(path) + ": " + valueOf(key) + "\n";
  }
  return text;
}

}  // namespace edgeslam
