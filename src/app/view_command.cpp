#include "app/view_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "app/command_line.h"
#include "configuration/input_configuration.h"
#include "map/saved_map.h"
#include "recording/open_frame_source.h"
#include "service/daemon.h"

namespace edgeslam {
namespace {

struct ViewArguments {
  std::string input, configuration, map_in;
  int port = -1;  // the configuration's
};

// Nothing is sent to a robot and nothing is written: it is for looking.
DaemonSetup setupOf(const ViewArguments& arguments, EventLog& log) {
  const std::unique_ptr<FrameSource> source = openFrameSource(arguments.input);
  DaemonSetup setup;
  setup.configuration = configurationFor(*source, arguments.configuration);
  setup.camera = cameraFor(*source, setup.configuration, arguments.input);
  if (const std::string doubt = calibrationDoubt(source->camera(), setup.configuration); !doubt.empty())
    log.tell(doubt);
  setup.capture.device = arguments.input;
  setup.capture.width = setup.camera.width;
  setup.capture.height = setup.camera.height;
  setup.for_viewing = true;
  ServiceOptions& service = setup.configuration.service;
  service.lcm = LcmOptions();
  service.lcm.url = "memq://";
  service.map_file.clear();
  service.goes_on_with_map = false;
  service.recordings_folder.clear();
  service.records_from_start = false;
  service.viewer.enabled = true;
  if (!arguments.map_in.empty()) {
    setup.map_in = loadMap(arguments.map_in, setup.camera);
  } else if (setup.configuration.settings.tracking.map_is_frozen) {
    throw InputError(arguments.configuration + ": map.frozen: there is no map to localise in; give one (--map-in)");
  }
  if (arguments.port >= 0) service.viewer.port = arguments.port;
  if (const std::string wrong = viewerProblem(service.viewer); !wrong.empty()) throw InputError(wrong);
  return setup;
}

int runView(const ViewArguments& arguments) {
  EventLog log(std::cerr);
  Daemon daemon(setupOf(arguments, log), log);
  daemon.run();
  return exit_done;
}

}  // namespace

void addViewCommand(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<ViewArguments>();
  CLI::App* command = app.add_subcommand(
      "view", "Run over recorded frames at their own pace, as on the robot, and show it on a page in the browser");
  command
      ->add_option("INPUT", arguments->input,
                   "As of `edgeslam replay`: folder of a dataset, folder of images, video, recording of a live run")
      ->required();
  command->add_option("--config", arguments->configuration, "Configuration file (YAML); its section viewer: counts");
  command->add_option("--map-in", arguments->map_in,
                      "Saved map of the same camera: frames are found in it, and it is extended, or with map.frozen "
                      "only localised in");
  command->add_option("--port", arguments->port, "Of the page, TCP (default: viewer.port, 8417); 0: a free one")
      ->check(CLI::Range(0, 65535));
  command->callback([arguments, &exit_code] { exit_code = runView(*arguments); });
}

}  // namespace edgeslam
