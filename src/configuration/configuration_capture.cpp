#include "configuration/configuration_capture.h"

#include <algorithm>
#include <cmath>

#include "configuration/configuration_keys.h"
#include "drivers/frame_capture/pixel_format.h"

namespace edgeslam {
namespace {

constexpr std::size_t most_controls = 100;

// The section's numbers, pointing into `options`.
std::vector<ConfigurationKey> numberKeys(CameraOptions& options) {
  return {
      {"capture.width", &options.width, "px", 16, 16384, "image width"},
      {"capture.height", &options.height, "px", 16, 16384, "image height"},
      {"capture.frame_rate", &options.frame_rate, "frames/s", 0.1, 1000, "frame rate"},
      {"capture.longest_exposure", &options.longest_exposure_ms, "ms", 0.01, 1000, "longest exposure"},
  };
}

// Controls that have a key of their own, and the word that each takes besides a number.
const std::vector<std::string>& sharedControls() {
  static const std::vector<std::string> names{"exposure", "gain", "white_balance", "focus", "power_line_frequency"};
  return names;
}

bool isSharedControl(const std::string& name) {
  return std::find(sharedControls().begin(), sharedControls().end(), name) != sharedControls().end();
}

// In the order in which controls are set: 0 for the driver's own.
std::ptrdiff_t placeOf(const std::string& control) {
  const auto found = std::find(sharedControls().begin(), sharedControls().end(), control);
  return found == sharedControls().end() ? 0 : 1 + (found - sharedControls().begin());
}

struct SectionReader {
  CameraOptions& options;
  const TellProblem& tell;

  void readNumbers(const YAML::Node& section) const {
    for (const ConfigurationKey& key : numberKeys(options)) {
      const YAML::Node value = section[key.path.substr(key.path.find('.') + 1)];
      if (!value) continue;
      const std::string wrong = value.IsScalar() ? setValue(key, value.Scalar()) : "not a number";
      if (!wrong.empty()) tell(value.Mark().line, key.path + ": " + wrong + "; expected " + expectedValue(key));
    }
    if (static_cast<bool>(section["width"]) != static_cast<bool>(section["height"])) {
      tell(section.Mark().line, "capture.width and capture.height go together");
    }
  }

  void readRegion(const YAML::Node& region) const {
    std::vector<int> numbers;
    bool good = region.IsSequence() && region.size() == 4;
    for (std::size_t i = 0; good && i < 4; ++i) {
      double value = -1;
      good = region[i].IsScalar() && parseNumber(region[i].Scalar(), value) && value == std::round(value) &&
             value >= (i < 2 ? 0 : 16) && value <= 65536;
      numbers.push_back(good ? static_cast<int>(value) : 0);
    }
    if (!good) {
      return tell(region.Mark().line,
                  "capture.region: four whole numbers are expected, [left, top, width, height] [px]");
    }
    options.region = {numbers[0], numbers[1], numbers[2], numbers[3]};
  }

  // Over what an included file said.
  void set(const std::string& name, const std::string& value) const {
    std::vector<ControlSetting>& controls = options.controls;
    controls.erase(std::remove_if(controls.begin(), controls.end(), [&](const auto& c) { return c.name == name; }),
                   controls.end());
    controls.push_back({name, value});
  }

  void readControl(const std::string& key, const std::string& name, const YAML::Node& value) const {
    if (!value.IsScalar() || value.Scalar().empty() || value.Scalar().size() > 100) {
      return tell(value.Mark().line, key + ": a number or a word is expected");
    }
    set(name, value.Scalar());
  }

  void readSharedControl(const std::string& name, const YAML::Node& value) const {
    const std::string key = "capture." + name;
    double number = 0;
    const bool is_line = name == "power_line_frequency";
    const std::string text = value.IsScalar() ? value.Scalar() : "";
    if (text == "auto" || (is_line && (text == "off" || text == "false"))) {  // off is false in YAML 1.1
      set(name, text == "auto" ? "auto" : "off");
    } else if (!parseNumber(text, number) || number < 0 || (is_line && number != 50 && number != 60)) {
      tell(value.Mark().line, key + ": '" + text + "' is not possible; expected " +
                                  (is_line ? "50, 60, off or auto" : "auto or a number from 0 on"));
    } else {
      set(name, text);
    }
  }

  void readControls(const YAML::Node& controls) const {
    if (!controls.IsMap() || controls.size() > most_controls) {
      return tell(controls.Mark().line, "capture.controls: a mapping of the driver's names to values is expected");
    }
    std::vector<std::string> seen;
    for (const auto& entry : controls) {
      const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "";
      const std::string key = "capture.controls." + name;
      if (name.empty() || isSharedControl(name)) {
        tell(entry.first.Mark().line,
             name.empty() ? "a key must be a plain word" : key + ": is given as capture." + name);
      } else if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
        tell(entry.first.Mark().line, key + " is given twice");
      } else {
        readControl(key, name, entry.second);
      }
      seen.push_back(name);
    }
  }
};

// As it can stand in "{...}", too, where a comma or bracket ends a word.
std::string quoted(const std::string& text) {
  YAML::Emitter emitter;
  if (text.find_first_of(",[]{}") != std::string::npos) emitter << YAML::DoubleQuoted;
  emitter << text;
  return emitter.c_str();
}

}  // namespace

std::vector<std::string> captureKeys() {
  std::vector<std::string> names{"capture.device", "capture.format", "capture.region", "capture.controls"};
  CameraOptions options;
  for (const ConfigurationKey& key : numberKeys(options)) names.push_back(key.path);
  for (const std::string& name : sharedControls()) names.push_back("capture." + name);
  return names;
}

void readCaptureSection(const YAML::Node& section, CameraOptions& options, const TellProblem& tell) {
  const SectionReader reader{options, tell};
  if (const YAML::Node device = section["device"]) {
    options.device = device.IsScalar() ? device.Scalar() : "";
    if (options.device.empty()) tell(device.Mark().line, "capture.device: a path or libcamera:NAME is expected");
  }
  if (const YAML::Node format = section["format"]) {
    options.format = format.IsScalar() ? format.Scalar() : "";
    if (!pixelFormatOfName(options.format)) {
      std::string names;
      for (const PixelFormat known : pixel_formats)
        names += (names.empty() ? "" : ", ") + std::string(pixelFormatName(known));
      tell(format.Mark().line, "capture.format: '" + options.format + "' is not known; expected one of " + names);
    }
  }
  reader.readNumbers(section);
  if (const YAML::Node region = section["region"]) reader.readRegion(region);
  // The driver's own first: what they set by hand (automatics) is then as the shared ones need it.
  if (const YAML::Node controls = section["controls"]) reader.readControls(controls);
  for (const std::string& name : sharedControls()) {
    if (const YAML::Node value = section[name]) reader.readSharedControl(name, value);
  }
  // The same order where an included file set some of them.
  std::stable_sort(options.controls.begin(), options.controls.end(),
                   [](const auto& a, const auto& b) { return placeOf(a.name) < placeOf(b.name); });
}

std::string formatCaptureSection(const CameraOptions& options) {
  std::string text;
  const auto append = [&](const std::string& key, const std::string& value) {
    text += "  " + key + ": " + value + "\n";
  };
  if (!options.device.empty()) append("device", quoted(options.device));
  if (!options.format.empty()) append("format", options.format);
  CameraOptions shown = options, usual;
  const std::vector<ConfigurationKey> keys = numberKeys(shown), usual_keys = numberKeys(usual);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::string value = valueText(keys[i].field);
    if (value != valueText(usual_keys[i].field)) append(keys[i].path.substr(keys[i].path.find('.') + 1), value);
  }
  const cv::Rect& region = options.region;
  if (!region.empty()) {
    append("region", "[" + std::to_string(region.x) + ", " + std::to_string(region.y) + ", " +
                         std::to_string(region.width) + ", " + std::to_string(region.height) + "]");
  }
  std::string own;
  for (const ControlSetting& control : options.controls) {
    if (isSharedControl(control.name)) {
      append(control.name, quoted(control.value));
    } else {
      own += (own.empty() ? "" : ", ") + quoted(control.name) + ": " + quoted(control.value);
    }
  }
  if (!own.empty()) append("controls", "{" + own + "}");
  return text.empty() ? "" : "capture:\n" + text;
}

std::string captureSectionDocumentation() {
  return "\n# The live camera. `edgeslam cameras` lists what is there, with the lines to put here. What is left out "
         "the "
         "driver\n"
         "# chooses. What the camera refuses is told when it is opened, with what it allows.\n"
         "capture:\n"
         "  # a name that stays the same camera's: /dev/v4l/by-id/..., /dev/v4l/by-path/..., libcamera:NAME; or a "
         "recording\n"
         "  # device: /dev/v4l/by-id/usb-046d_HD_Pro_Webcam_C920-video-index0\n"
         "  # GREY, Y10, Y12, Y16, NV12, NV21, YU12, YUYV, UYVY, MJPEG, RGB24 or BGR24 (default: of the fastest the "
         "one "
         "of\n"
         "  # the least work)\n"
         "  # format: YUYV\n"
         "  # (16 to 16384 px; default: the driver's, or the calibration's)\n"
         "  # width: 640\n"
         "  # height: 480\n"
         "  # (0.1 to 1000 frames/s; default: the fastest up to 30)\n"
         "  # frame_rate: 30\n"
         "  # part of the sensor that is read, [left, top, width, height] [px]\n"
         "  # region: [0, 0, 1280, 960]\n"
         "  # auto, or the exposure time [ms]; fixed, it also makes the time stamps those of its middle\n"
         "  # exposure: 8\n"
         "  # the automatic exposure stays below this, against blur, where the driver lets it be set (0.01 to 1000 "
         "ms)\n"
         "  # longest_exposure: 10\n"
         "  # auto, or a number: in the driver's units; for white_balance [K]\n"
         "  # gain: auto\n"
         "  # white_balance: 4500\n"
         "  # focus: 0\n"
         "  # lights that flicker at 50 or 60 Hz; off or auto\n"
         "  # power_line_frequency: 50\n"
         "  # any other control, by the name that `edgeslam cameras` shows\n"
         "  # controls: {brightness: 128, sharpness: 3}\n";
}

}  // namespace edgeslam
