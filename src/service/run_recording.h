// The recording of a run: whether it goes on, its end by command or with the run, and what the log is told of it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "recording/flight_recorder.h"
#include "service/background_work.h"
#include "service/command_answers.h"
#include "service/event_log.h"

namespace edgeslam {

// For the publishing thread.
class RunRecording {
 public:
  // What is referred to outlives it; work that was begun may outlive this object.
  RunRecording(CommandAnswers& answers, BackgroundWork& disk_work, EventLog& log)
      : answers_(answers), disk_work_(disk_work), log_(log) {}

  // `recorder` is null where the run is not recorded.
  void begin(std::shared_ptr<FlightRecorder> recorder);
  // With its run. What the disk still has to take goes on in the background.
  void end();
  // A command stop_recording.
  void stop(const Command& command);

  bool goesOn() const { return recorder_ && recorder_->status().recording; }
  bool hasGaps() const { return goesOn() && recorder_->status().not_recorded > 0; }
  // How it goes, in words; while it goes on.
  std::string message() const { return recorder_->status().message; }

  // An end that nobody asked for, and gaps; `going_on`: as the status has it.
  void tellChanges(bool going_on);

 private:
  void endFor(const std::optional<Command>& command);

  CommandAnswers& answers_;
  BackgroundWork& disk_work_;
  EventLog& log_;
  std::shared_ptr<FlightRecorder> recorder_;
  bool told_going_on_ = false, told_gaps_ = false;  // what the log was told last
};

}  // namespace edgeslam
