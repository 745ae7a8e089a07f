#include "service/daemon_page.h"

#include <cassert>
#include <chrono>
#include <optional>
#include <thread>

#include "service/map_publisher.h"

namespace edgeslam {
namespace {

constexpr auto glance = std::chrono::milliseconds(50);

}  // namespace

DaemonPage::DaemonPage(const DaemonSetup& setup, const std::string& camera, DaemonSignals& signals, EventLog& log)
    : signals_(signals), log_(log) {
  const ViewerOptions& options = setup.configuration.service.viewer;
  if (!options.enabled) return;
  try {
    viewer_ = std::make_unique<Viewer>(options, ViewerSetup{EDGESLAM_VERSION, camera, setup.camera, commandsOf(setup)});
  } catch (const InputError& error) {
    if (setup.for_viewing) throw;
    log_.tell(std::string("runs on without a page: ") + error.what());
    return;
  }
  log_.tell("the page is at " + viewer_->address() + (options.token.empty() ? "" : "?token=... (viewer.token)"));
}

void DaemonPage::waitUntilWatched() {
  assert(viewer_);
  log_.tell("waits until a browser shows the page; Ctrl-C ends");
  while (!viewer_->isWatched() && !signals_.end()) std::this_thread::sleep_for(glance);
}

void DaemonPage::showUntilSignal(const Map& map) {
  assert(viewer_);
  viewer_->map(std::make_shared<const Map>(map), largestWorld(map));
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
