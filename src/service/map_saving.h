// The map's file, written while the run goes on: by command, or by a signal.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/camera.h"
#include "pipeline/live_run.h"
#include "service/background_work.h"
#include "service/command_answers.h"
#include "service/event_log.h"

namespace edgeslam {

// For the publishing thread.
class MapSaving {
 public:
  // `file`: empty: the map is not saved, for it `is_frozen` or nobody named one. What is referred to outlives it; work
  // that was begun may outlive this object.
  MapSaving(const Camera& camera, const std::string& file, bool is_frozen, CommandAnswers& answers,
            BackgroundWork& disk_work, EventLog& log);

  void begin(LiveRun& run) { run_ = &run; }
  // What was asked for and did not come is answered so.
  void end();

  // The map is saved as it is next; `command` gets the answer. None: asked for by a signal.
  void ask(const std::optional<Command>& command);
  // One that the run was asked for, by whomever.
  void mapCame(const std::shared_ptr<const Map>& map);

 private:
  // Of each the command, or none.
  using Wishes = std::vector<std::optional<Command>>;

  void answer(const Wishes& wishes, const CommandOutcome& outcome);

  const Camera camera_;
  const std::string file_;
  const bool is_frozen_;
  CommandAnswers& answers_;
  BackgroundWork& disk_work_;
  EventLog& log_;
  LiveRun* run_ = nullptr;  // from begin() on
  Wishes wishes_;
};

}  // namespace edgeslam
