#include "app/check_config_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "app/command_line.h"
#include "configuration/configuration.h"
#include "configuration/configuration_capture.h"
#include "configuration/configuration_keys.h"
#include "configuration/configuration_text.h"
#include "files/format_text.h"
#include "frames/calibration_file.h"

namespace edgeslam {
namespace {

void listCamera(const Camera& camera, const std::string& doubt) {
  std::cout << "  camera: " << camera.width << " x " << camera.height << " px, "
            << (camera.model == CameraModel::kannala_brandt ? "Kannala-Brandt fisheye" : "pinhole, radial-tangential")
            << ", focal lengths " << camera.fx << " " << camera.fy << " px, centre " << camera.cx << " " << camera.cy
            << " px\n";
  if (camera.readout_s != 0) std::cout << "  rows are read over " << 1e3 * camera.readout_s << " ms\n";
  if (!doubt.empty()) std::cout << "  " << doubt << "\n";
}

void listDifferences(const Configuration& configuration) {
  Configuration shown = configuration, usual;
  const std::vector<ConfigurationKey> keys = configurationKeys(shown), usual_keys = configurationKeys(usual);
  std::string changes;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const ConfigurationKey& key = keys[i];
    if (!key.hasField() || key.section() == "capture" || key.path == "viewer.token") continue;
    const std::string value = valueText(key.field), default_value = valueText(usual_keys[i].field);
    if (value == default_value) continue;
    changes.append("  ").append(key.path).append(": ").append(value);
    changes.append(" (default ").append(default_value).append(")\n");
  }
  changes += formatCaptureSection(configuration.capture);
  std::cout << configuration.source << ": a good configuration; "
            << (changes.empty() ? "all settings are the defaults" : "what differs from the defaults:") << "\n"
            << changes;
  if (configuration.mask) {
    std::cout << formatted("  mask: %s, %.1f %% of the image\n", configuration.mask_path.c_str(),
                           100 * maskedShare(*configuration.mask));
  }
  if (configuration.camera) {
    listCamera(*configuration.camera, configuration.camera_doubt);
    if (configuration.settings.mapping.camera_finding.lens_is_presumed)
      std::cout << "  its lens is presumed, and looked for on the way\n";
  } else {
    std::cout << "  camera: not given; taken from beside the recording\n";
    if (configuration.readout_s) {
      std::cout << "  its rows are read over " << 1e3 * *configuration.readout_s << " ms, whatever it says itself\n";
    }
  }
}

int checkConfiguration(const std::string& path) {
  if (isCalibrationFile(path)) {
    const Camera camera = readCalibration(path);
    const std::string doubt = doubtfulDistortion(camera);
    std::cout << path << (doubt.empty() ? ": a good calibration\n" : ": a calibration that can be read\n");
    listCamera(camera, doubt);
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
    bool print_default = false, print_expert = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("check-config", "Check a configuration or calibration file and say what it changes");
  CLI::Option* file = command->add_option("FILE", options->path, "Configuration or camera calibration (YAML)");
  CLI::Option* print = command->add_flag("--print-default", options->print_default,
                                         "Print what a user has reason to change, with its defaults");
  CLI::Option* print_expert =
      command->add_flag("--print-expert", options->print_expert, "Print the other keys, those of the method");
  file->excludes(print);
  file->excludes(print_expert);
  print->excludes(print_expert);
  command->callback([options, &exit_code] {
    if (options->print_default) {
      std::cout << usersConfigurationText();
    } else if (options->print_expert) {
      std::cout << expertConfigurationText();
    } else if (options->path.empty()) {
      throw CLI::RequiredError("FILE");
    } else {
      exit_code = checkConfiguration(options->path);
    }
  });
}

}  // namespace edgeslam
