// Carries out the commands of the robot and of the person who looks on, and sees to it that each is answered.
#pragma once

#include "service/capture_link.h"
#include "service/command_answers.h"
#include "service/map_publisher.h"
#include "service/map_saving.h"
#include "service/metric_scale.h"
#include "service/run_recording.h"

namespace edgeslam {

// Who does what a command asks for. All outlive RunCommands.
struct CommandTargets {
  CaptureLink& capture;
  MapPublisher& map;
  MapSaving& saving;
  RunRecording& recording;
  MetricScale& scale;
};

// For the publishing thread, while there is a run.
class RunCommands {
 public:
  // `begins_anew`: capture carries out commands that begin another run.
  RunCommands(const CommandTargets& targets, CommandAnswers& answers, bool begins_anew)
      : targets_(targets), answers_(answers), begins_anew_(begins_anew) {}

  void carryOut(const Command& command);
  // Of commands that capture has carried out.
  void passOnAnswers();

 private:
  void startRecording(const Command& command);
  void sendMap(const Command& command);
  void passToCapture(const Command& command);

  CommandTargets targets_;
  CommandAnswers& answers_;
  bool begins_anew_;
};

}  // namespace edgeslam
