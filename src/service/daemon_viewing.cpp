// The page for people who look on: opened with the daemon; and a recording that is run for them alone.
#include <chrono>
#include <memory>
#include <thread>
#include <utility>

#include "service/daemon.h"

namespace edgeslam {
namespace {

constexpr auto glance = std::chrono::milliseconds(50);

// Those that can be carried out at all.
std::vector<std::string> commandsOf(const DaemonSetup& setup) {
  const ServiceOptions& service = setup.configuration.service;
  std::vector<std::string> commands{"reset", "set_scale"};
  if (!setup.map_out.empty()) commands.emplace_back("save_map");
  if (!service.recordings_folder.empty()) commands.insert(commands.end(), {"start_recording", "stop_recording"});
  if (!setup.for_viewing) commands.emplace_back("send_map");
  return commands;
}

}  // namespace

// A robot whose page cannot be served goes on giving poses; a page that was all that was asked for is another matter.
void Daemon::openViewer() {
  const ViewerOptions& options = setup_.configuration.service.viewer;
  const ViewerSetup setup{EDGESLAM_VERSION, camera_->stream().camera, setup_.camera, commandsOf(setup_)};
  try {
    viewer_ = std::make_unique<Viewer>(options, setup);
  } catch (const InputError& error) {
    if (setup_.for_viewing) throw;
    return log_.tell(std::string("runs on without a page: ") + error.what());
  }
  log_.tell("the page is at " + viewer_->address() + (options.token.empty() ? "" : "?token=... (viewer.token)"));
}

void Daemon::waitForViewer() {
  log_.tell("waits until a browser shows the page; Ctrl-C ends");
  while (!viewer_->isWatched() && !signals_.end()) std::this_thread::sleep_for(glance);
  ended_ = signals_.end();
}

// After the run: the map can still be turned, commands are of no use any more.
void Daemon::showUntilSignal(const Map& map) {
  viewer_->map(std::make_shared<const Map>(map));
  viewer_->note("The recording is at its end. The map can still be looked at.");
  log_.tell("shows the page until Ctrl-C");
  while (!signals_.end()) {
    while (const std::optional<Command> command = viewer_->nextCommand()) {
      viewer_->answer(*command, false, "the recording is at its end");
    }
    std::this_thread::sleep_for(glance);
  }
}

}  // namespace edgeslam
