// The way back to whoever sent a command: the robot, or a person who looks on.
#pragma once

#include <string>

#include "drivers/lcm/lcm_publisher.h"
#include "drivers/viewer/viewer.h"

namespace edgeslam {

// What became of a command.
struct CommandOutcome {
  bool accepted = false;
  std::string message;  // for the sender
};

// For the publishing thread.
class CommandAnswers {
 public:
  // Both outlive it; `viewer` is null where nobody can look on.
  CommandAnswers(LcmPublisher& publisher, Viewer* viewer) : publisher_(publisher), viewer_(viewer) {}

  // To be called once for every command.
  void answer(const Command& command, const CommandOutcome& outcome) {
    if (command.sender == CommandSender::robot) {
      return publisher_.answer(command, outcome.accepted, outcome.message);
    }
    if (viewer_) viewer_->answer(command, outcome.accepted, outcome.message);
  }

 private:
  LcmPublisher& publisher_;
  Viewer* viewer_;
};

}  // namespace edgeslam
