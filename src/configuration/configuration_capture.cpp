#include "configuration/configuration_capture.h"

#include <algorithm>
#include <cmath>

#include "configuration/configuration_keys.h"
#include "drivers/frame_capture/pixel_format.h"

namespace edgeslam {
namespace {

constexpr std::size_t most_controls = 100;

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

}  // namespace

void readCaptureSection(const YAML::Node& section, CameraOptions& options, const TellProblem& tell) {
  const SectionReader reader{options, tell};
  if (const YAML::Node format = section["format"]; format && !pixelFormatOfName(options.format)) {
    std::string names;
    for (const PixelFormat known : pixel_formats)
      names += (names.empty() ? "" : ", ") + std::string(pixelFormatName(known));
    tell(format.Mark().line, "capture.format: '" + options.format + "' is not known; expected one of " + names);
  }
  if (static_cast<bool>(section["width"]) != static_cast<bool>(section["height"])) {
    tell(section.Mark().line, "capture.width and capture.height go together");
  }
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
  Configuration shown, usual;
  shown.capture = options;
  const std::vector<ConfigurationKey> keys = configurationKeys(shown), usual_keys = configurationKeys(usual);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i].section() != "capture" || !keys[i].hasField()) continue;
    const std::string value = valueText(keys[i].field);
    if (value != valueText(usual_keys[i].field)) append(keys[i].name(), value);
  }
  const cv::Rect& region = options.region;
  if (!region.empty()) {
    append("region", "[" + std::to_string(region.x) + ", " + std::to_string(region.y) + ", " +
                         std::to_string(region.width) + ", " + std::to_string(region.height) + "]");
  }
  std::string own;
  for (const ControlSetting& control : options.controls) {
    if (isSharedControl(control.name)) {
      append(control.name, inQuotes(control.value));
    } else {
      own += (own.empty() ? "" : ", ") + inQuotes(control.name) + ": " + inQuotes(control.value);
    }
  }
  if (!own.empty()) append("controls", "{" + own + "}");
  return text.empty() ? "" : "capture:\n" + text;
}

}  // namespace edgeslam
