#include "service/run_recording.h"

#include <utility>

namespace edgeslam {

void RunRecording::begin(std::shared_ptr<FlightRecorder> recorder) {
  recorder_ = std::move(recorder);
  told_going_on_ = goesOn();
  told_gaps_ = false;
}

void RunRecording::end() {
  if (told_going_on_) endFor({});
  recorder_.reset();
}

void RunRecording::stop(const Command& command) {
  if (!goesOn()) return answers_.answer(command, {false, "there is no recording"});
  endFor(command);
}

// Without a command: with its run.
void RunRecording::endFor(const std::optional<Command>& command) {
  told_going_on_ = false;  // it is told here
  disk_work_.begin([this, command, recorder = std::exchange(recorder_, nullptr)]() -> BackgroundWork::Completion {
    const std::string message = recorder->stop().message;
    return [this, command, message] {
      log_.tell(message);
      if (command) answers_.answer(*command, {true, message});
    };
  });
}

void RunRecording::tellChanges(bool going_on) {
  if (told_going_on_ && !going_on && recorder_) log_.tell(recorder_->status().message);
  told_going_on_ = going_on;
  if (!told_gaps_ && hasGaps()) {
    told_gaps_ = true;
    log_.tell("recording to " + recorder_->folder() + ", with gaps: it will not repeat the run");
  }
}

}  // namespace edgeslam
