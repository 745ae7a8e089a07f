#include "app/check_config_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "app/command_line.h"
#include "configuration/configuration.h"
#include "configuration/configuration_capture.h"
#include "configuration/configuration_keys.h"
#include "configuration/configuration_service.h"
#include "frames/calibration_file.h"

namespace edgeslam {
namespace {

void listCamera(const Camera& camera) {
  std::cout << "  camera: " << camera.width << " x " << camera.height << " px, "
            << (camera.model == CameraModel::kannala_brandt ? "Kannala-Brandt fisheye" : "pinhole, radial-tangential")
            << ", focal lengths " << camera.fx << " " << camera.fy << " px, centre " << camera.cx << " " << camera.cy
            << " px\n";
}

void listDifferences(const Configuration& configuration) {
  Settings settings = configuration.settings;
  Settings defaults;
  const std::vector<ConfigurationKey> keys = configurationKeys(settings);
  const std::vector<ConfigurationKey> default_keys = configurationKeys(defaults);
  std::string changes;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::string value = valueText(keys[i].field), usual = valueText(default_keys[i].field);
    if (value == usual) continue;
    changes.append("  ").append(keys[i].path).append(": ").append(value);
    changes.append(" (default ").append(usual).append(")\n");
  }
  std::cout << configuration.source << ": a good configuration; "
            << (changes.empty() ? "all settings are the defaults" : "what differs from the defaults:") << "\n"
            << changes;
  std::cout << formatCaptureSection(configuration.capture) << formatServiceSections(configuration);
  if (configuration.camera) {
    listCamera(*configuration.camera);
  } else {
    std::cout << "  camera: not given; taken from beside the recording\n";
  }
}

int checkConfiguration(const std::string& path) {
  if (isCalibrationFile(path)) {
    const Camera camera = readCalibration(path);
    std::cout << path << ": a good calibration\n";
    listCamera(camera);
    return exit_done;
  }
  std::vector<std::string> problems;
  const Configuration configuration = readConfiguration(path, problems);
  for (const std::string& problem : problems) std::cerr << problem << "\n";
  if (!problems.empty()) return exit_bad_input;
  listDifferences(configuration);
  return exit_done;
}

}  // namespace

void addCheckConfigCommand(CLI::App& app, int& exit_code) {
  struct Options {
    std::string path;
    bool print_default = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("check-config", "Check a configuration or calibration file and say what it changes");
  CLI::Option* file = command->add_option("FILE", options->path, "Configuration or camera calibration (YAML)");
  CLI::Option* print = command->add_flag("--print-default", options->print_default,
                                         "Print the default configuration, with documentation");
  file->excludes(print);
  command->callback([options, &exit_code] {
    if (options->print_default) {
      std::cout << defaultConfigurationText();
    } else if (options->path.empty()) {
      throw CLI::RequiredError("FILE");
    } else {
      exit_code = checkConfiguration(options->path);
    }
  });
}

}  // namespace edgeslam
