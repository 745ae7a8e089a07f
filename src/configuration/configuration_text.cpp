#include "configuration/configuration_text.h"

#include <sstream>
#include <vector>

#include "configuration/configuration_camera.h"
#include "configuration/configuration_capture.h"
#include "configuration/configuration_imu.h"
#include "configuration/configuration_keys.h"
#include "recording/recording_layout.h"

namespace edgeslam {
namespace {

// As a comment, line by line.
std::string comment(const std::string& text, const std::string& indent) {
  std::istringstream lines(text);
  std::string commented, line;
  while (std::getline(lines, line)) commented += indent + "# " + line + "\n";
  return commented;
}

// The key with its documentation above it; commented out where its default cannot be written.
std::string documented(const ConfigurationKey& key) {
  const bool is_number = key.hasField() && !std::holds_alternative<std::string*>(key.field);
  const std::string expected = is_number ? " (" + expectedValue(key) + ")" : "";
  const std::string line = key.name() + ": " + (key.example.empty() ? valueText(key.field) : key.example) + "\n";
  return comment(key.documentation + expected, "  ") + (key.example.empty() ? "  " : "  # ") + line;
}

std::string inOneLine(const ConfigurationKey& key) {
  return "  " + key.name() + ": " + valueText(key.field) + "  # " + key.documentation + " (" + expectedValue(key) +
         ")\n";
}

// All keys for users or all others, each section with its heading.
template <typename Format>
std::string listing(bool for_users, const Format& format) {
  Configuration usual;
  std::string text, heading, section;
  for (const ConfigurationKey& key : configurationKeys(usual)) {
    if (key.isHeading()) {
      heading = key.documentation;
    } else if (key.for_users == for_users) {
      if (key.section() != section) {
        section = key.section();
        text += "\n" + comment(heading + ".", "") + section + ":\n";
      }
      text += format(key);
    }
  }
  return text;
}

}  // namespace

std::string formatConfiguration(const Configuration& configuration) {
  Configuration shown = configuration, usual;
  const std::vector<ConfigurationKey> keys = configurationKeys(shown), usual_keys = configurationKeys(usual);
  std::string text = formatCameraSection(configuration) + formatCaptureSection(configuration.capture) +
                     formatImuSection(configuration.inertia),
              section;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const ConfigurationKey& key = keys[i];
    if (!key.hasField() || key.section() == "capture" || key.section() == "imu" || key.section() == "viewer") continue;
    const std::string value = valueText(key.field);
    if (!isOfMethod(key) && value == valueText(usual_keys[i].field)) continue;
    if (key.section() != section) text += key.section() + ":\n";
    section = key.section();
    text += "  " + key.name() + ": " + value + "\n";
  }
  return text;
}

std::string formatRecordedConfiguration(Configuration configuration) {
  configuration.mask_path = recording_mask_name;
  return formatConfiguration(configuration);
}

std::string usersConfigurationText() {
  return "# Configuration of Edge SLAM: what a user has reason to change, with its meaning, its range and its "
         "default.\n"
         "# Leave out what you do not change. `edgeslam check-config FILE` says what is wrong with a file, or what it\n"
         "# changes. Lengths of the scene are in map units, a sigma is a standard deviation. The method's own keys are "
         "in\n"
         "# expert.yaml; they can stand in the same file.\n\n"
         "# Another configuration, relative to this file, to begin with; what this file says counts.\n"
         "# include: profiles/low-power.yaml\n" +
         listing(true, documented);
}

std::string expertConfigurationText() {
  return "# The method's own keys, with their defaults: for experiments. What a robot's owner has reason to change is "
         "in\n"
         "# edgeslam.yaml.\n" +
         listing(false, inOneLine);
}

}  // namespace edgeslam
