// The service on the robot: camera to live run to LCM, until a signal ends it. Runs that are begun anew (reset, start
// of a recording) follow each other in the same process, camera and LCM staying open.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "configuration/configuration.h"
#include "drivers/frame_capture/reopening_camera.h"
#include "drivers/viewer/viewer.h"
#include "service/background_work.h"
#include "service/capture_link.h"
#include "service/daemon_signals.h"
#include "service/event_log.h"
#include "service/run_publisher.h"

namespace edgeslam {

struct DaemonSetup {
  Configuration configuration;
  Camera camera;
  CameraOptions capture;      // the configuration's, or a recording as a stand-in
  std::string record_folder;  // of a recording from the start; empty: none
  std::optional<Map> map_in;  // gone on with
  std::string map_out;        // empty: not written
  bool for_viewing = false;   // begins when someone looks on, and goes on after the end until a signal
};

class Daemon {
 public:
  // Tells what can go wrong, opens the camera (or waits for it later) and LCM. Throws InputError for what waiting does
  // not heal.
  Daemon(DaemonSetup setup, EventLog& log);

  // Until SIGTERM, SIGINT or the end of a recording as a camera. Throws InputError where the map cannot be written at
  // the end.
  void run();

 private:
  // Why a run ended: the end of all, or a command that begins another one.
  struct RunEnd {
    std::optional<Command> command;
    bool settles = false;  // the frames are at their end: mapping finishes
  };
  // For this command a recording is being opened.
  struct Preparation {
    Command command;
    std::chrono::steady_clock::time_point until;  // it is given up then
    std::shared_ptr<std::atomic<bool>> given_up = std::make_shared<std::atomic<bool>>(false);
  };

  void tellStartProblems();
  void tellProcessorProblems(const LiveRun& run);
  void oneRun();
  RunEnd capture(LiveRun& run);
  void take(const Capture& capture, LiveRun& run);
  void takeDamaged(const Capture& capture, LiveRun& run);
  void prepare(const Command& command);
  void seeToPreparation();
  void cannotRecord(const Command& command, const std::string& problem);
  void beginNext(const Command& command, LiveRun& run);
  std::shared_ptr<FlightRecorder> openRecording(const std::string& folder) const;
  std::shared_ptr<FlightRecorder> recordTo(const std::string& folder);
  void recordWhereConfigured();
  std::string nextRecordingFolder() const;
  void saveMapAtStart(const Map& map, const std::string& folder);
  void writeMap(const Map& map);

  // daemon_viewing.cpp.
  void openViewer();
  void waitForViewer();
  void showUntilSignal(const Map& map);

  DaemonSignals signals_;  // first: threads inherit what is blocked
  DaemonSetup setup_;
  EventLog& log_;
  CaptureLink link_;
  std::unique_ptr<ReopeningCamera> camera_;
  std::unique_ptr<Viewer> viewer_;  // null where nobody can look on
  std::unique_ptr<RunPublisher> publisher_;
  std::shared_ptr<FlightRecorder> recorder_;
  std::shared_ptr<FlightRecorder> next_recorder_;  // of the run to come
  std::optional<Preparation> preparation_;
  std::optional<Command> prepared_;  // that can be carried out now

  RunStart start_ = RunStart::new_map;
  std::optional<Map> map_;  // that the run to come goes on with
  bool ended_ = false;
  std::int64_t index_ = -1, time_ns_ = -1;  // of the last frame handed over
  bool damage_told_ = false, processors_told_ = false;

  BackgroundWork disk_work_;  // last: the others outlive it
};

}  // namespace edgeslam
