// The page for people who look on: opened with the daemon; and a recording that is run for them alone.
#pragma once

#include <memory>
#include <string>

#include "drivers/viewer/viewer.h"
#include "service/daemon_setup.h"
#include "service/daemon_signals.h"
#include "service/event_log.h"

namespace edgeslam {

class DaemonPage {
 public:
  // `camera`: its name. A robot whose page cannot be served goes on giving poses; throws InputError where the page was
  // all that was asked for. Both references outlive it.
  DaemonPage(const DaemonSetup& setup, const std::string& camera, DaemonSignals& signals, EventLog& log);

  // Null where nobody can look on. Lasts as long as the page.
  Viewer* viewer() const { return viewer_.get(); }

  // Where there is a viewer. Waits until someone looks on, or a signal ends the daemon.
  void waitUntilWatched();
  // After the run: the map can still be turned, commands are of no use any more. Until a signal.
  void showUntilSignal(const Map& map);

 private:
  DaemonSignals& signals_;
  EventLog& log_;
  std::unique_ptr<Viewer> viewer_;
};

}  // namespace edgeslam
