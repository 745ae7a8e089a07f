#include "app/run_command.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "app/command_line.h"
#include "configuration/input_configuration.h"
#include "frames/frame_source.h"
#include "map/saved_map.h"
#include "recording/open_frame_source.h"
#include "service/daemon.h"

namespace edgeslam {
namespace {

struct RunArguments {
  std::string configuration, source, record, map_in, map_out;
};

Camera cameraOf(const RunArguments& arguments, const Configuration& configuration, EventLog& log) {
  std::optional<Camera> beside;
  if (!arguments.source.empty()) beside = openFrameSource(arguments.source)->camera();
  if (const std::string doubt = calibrationDoubt(beside, configuration); !doubt.empty()) log.tell(doubt);
  if (configuration.camera) return *configuration.camera;
  if (beside) return asConfigured(*beside, configuration);
  throw InputError((arguments.configuration.empty() ? "" : arguments.configuration + ": ") +
                   "no calibration of the camera; give one (camera.calibration), or its size alone (camera.width and "
                   "camera.height) to have it found on the way");
}

// A map that cannot be continued is no reason not to start: it is set aside, so that it is not written over.
std::optional<Map> configuredMap(const std::string& path, const Camera& camera, EventLog& log) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  try {
    return loadMap(path, camera);
  } catch (const InputError& error) {
    const std::string aside = path + ".refused";
    std::error_code failed;
    std::filesystem::rename(path, aside, failed);
    log.tell(std::string(error.what()) + "; begun without a map" + (failed ? "" : ", this one is now " + aside));
    return std::nullopt;
  }
}

// A map that is only localised in must be there: nothing else can take its place.
Map frozenMap(const RunArguments& arguments, const ServiceOptions& service, const Camera& camera) {
  const std::string& path = arguments.map_in.empty() ? service.map_file : arguments.map_in;
  if (path.empty()) {
    throw InputError((arguments.configuration.empty() ? "" : arguments.configuration + ": ") +
                     "map.frozen: there is no map to localise in; give one (map.file, or --map-in)");
  }
  return loadMap(path, camera);
}

DaemonSetup setupOf(const RunArguments& arguments, EventLog& log) {
  DaemonSetup setup;
  if (!arguments.configuration.empty()) setup.configuration = readConfiguration(arguments.configuration);
  const ServiceOptions& service = setup.configuration.service;
  setup.camera = cameraOf(arguments, setup.configuration, log);
  setup.configuration.settings = settingsWithSensors(setup.configuration);
  setup.camera = withReadoutOfUnit(setup.camera, setup.configuration);
  setup.capture = setup.configuration.capture;
  if (!arguments.source.empty()) {
    setup.capture = CameraOptions();
    setup.capture.device = arguments.source;
  }
  if (setup.capture.width == 0) {
    setup.capture.width = setup.camera.width;
    setup.capture.height = setup.camera.height;
  }
  if (setup.configuration.settings.wheels.enabled && service.scale.odometry.channel.empty()) {
    throw InputError(
        setup.configuration.source +
        ": wheels.enabled: it is not known where the wheels' poses come from; give scale.odometry_channel");
  }
  setup.record_folder = arguments.record;
  const bool is_frozen = setup.configuration.settings.tracking.map_is_frozen;
  setup.map_out = arguments.map_out.empty() && !is_frozen ? service.map_file : arguments.map_out;
  if (!setup.map_out.empty()) requireMapCanBeSaved(setup.map_out);
  if (is_frozen) {
    setup.map_in = frozenMap(arguments, service, setup.camera);
  } else if (!arguments.map_in.empty()) {
    setup.map_in = loadMap(arguments.map_in, setup.camera);
  } else if (service.goes_on_with_map && !service.map_file.empty()) {
    setup.map_in = configuredMap(service.map_file, setup.camera, log);
  }
  return setup;
}

int runService(const RunArguments& arguments) {
  EventLog log(std::cerr);
  Daemon daemon(setupOf(arguments, log), log);
  daemon.run();
  return exit_done;
}

}  // namespace

void addRunCommand(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<RunArguments>();
  const auto named = [](const std::string& name) { return std::string(name.empty() ? "expected a file's name" : ""); };
  CLI::App* command =
      app.add_subcommand("run", "Poses from the camera to LCM, until SIGTERM or SIGINT; SIGHUP writes the map");
  command->add_option("--config", arguments->configuration, "Configuration (YAML): camera, capture, lcm, map, ...");
  command
      ->add_option("--source", arguments->source,
                   "Recording, folder or video as a stand-in for the camera, at the pace of its time stamps")
      ->check(named);
  command->add_option("--record", arguments->record, "Folder for a recording of this run, from the start")
      ->check(named);
  command
      ->add_option("--map-in", arguments->map_in,
                   "Saved map of the same camera, which is extended, or with map.frozen only localised in")
      ->check(named);
  command->add_option("--map-out", arguments->map_out, "File for the map (default: map.file of the configuration)")
      ->check(named);
  command->callback([arguments, &exit_code] { exit_code = runService(*arguments); });
}

}  // namespace edgeslam
