// The recording of the run to come: opened at the start or, for a command, while the run before goes on.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "configuration/configuration.h"
#include "drivers/lcm/commands.h"
#include "geometry/camera.h"
#include "map/map.h"
#include "recording/flight_recorder.h"
#include "service/background_work.h"
#include "service/capture_link.h"
#include "service/event_log.h"

namespace edgeslam {

// For the thread that starts and ends runs, which is capture's.
class NextRecording {
 public:
  // All outlive it.
  NextRecording(const Configuration& configuration, const Camera& camera, CaptureLink& link, EventLog& log)
      : configuration_(configuration), camera_(camera), link_(link), log_(log) {}

  // At once. Throws InputError where it cannot be begun.
  void openTo(const std::string& folder);
  // At once, where the configuration says so. A disk that does not take it is told, and is no reason to give no poses.
  void openWhereConfigured();

  // The run goes on until the disk, which may be slow, has the folder of the next one's recording. A command that
  // cannot be carried out is answered.
  void prepareFor(const Command& command);
  bool isUnderway() const { return preparation_.has_value(); }
  // Between two frames, while it is under way.
  void seeToPreparation();
  // The command that can be carried out now, once; another run is to begin for it.
  std::optional<Command> takePrepared();

  bool isOpen() const { return recorder_ != nullptr; }
  // Where it is open.
  const std::string& folder() const;
  // Where it is open: the map that the run to come begins with, without which the recording does not repeat it.
  void keepMap(const Map& map);
  // The run to come begins. Null where it is not recorded.
  std::shared_ptr<FlightRecorder> take();

 private:
  // For this command a recording is being opened.
  struct Preparation {
    Command command;
    std::chrono::steady_clock::time_point until;  // it is given up then
    std::shared_ptr<std::atomic<bool>> given_up = std::make_shared<std::atomic<bool>>(false);
  };

  std::shared_ptr<FlightRecorder> open(const std::string& folder) const;
  BackgroundWork::Completion openInBackground(const Command& command,
                                              const std::shared_ptr<std::atomic<bool>>& given_up);
  void cannotRecord(const Command& command, const std::string& problem);

  const Configuration& configuration_;
  const Camera& camera_;
  CaptureLink& link_;
  EventLog& log_;
  std::shared_ptr<FlightRecorder> recorder_;
  std::optional<Preparation> preparation_;
  std::optional<Command> prepared_;
  BackgroundWork disk_work_;  // last: the others outlive it
};

}  // namespace edgeslam
