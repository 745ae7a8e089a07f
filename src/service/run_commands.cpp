#include "service/run_commands.h"

namespace edgeslam {

void RunCommands::carryOut(const Command& command) {
  switch (command.kind) {
    case CommandKind::reset:
      return passToCapture(command);
    case CommandKind::save_map:
      return targets_.saving.ask(command);
    case CommandKind::start_recording:
      return startRecording(command);
    case CommandKind::stop_recording:
      return targets_.recording.stop(command);
    case CommandKind::set_scale:
      return answers_.answer(command, targets_.scale.set(command));
    case CommandKind::send_map:
      return sendMap(command);
  }
}

void RunCommands::passOnAnswers() {
  for (const CaptureLink::Answer& given : targets_.capture.takeAnswers()) {
    answers_.answer(given.command, {given.accepted, given.message});
  }
}

void RunCommands::startRecording(const Command& command) {
  if (!targets_.recording.goesOn()) return passToCapture(command);
  answers_.answer(command, {false, targets_.recording.message() + " already"});
}

void RunCommands::sendMap(const Command& command) {
  targets_.map.ask();
  answers_.answer(command, {true, "the map follows"});
}

void RunCommands::passToCapture(const Command& command) {
  if (!begins_anew_) {
    answers_.answer(command, {false, "a replay does not begin anew"});
  } else if (!targets_.capture.request(command) && !targets_.capture.isUnderway(command)) {
    answers_.answer(command, {false, "another command is still being carried out; send it again"});
  }
}

}  // namespace edgeslam
