#include "service/map_saving.h"

#include <cassert>
#include <exception>
#include <utility>

#include "map/saved_map.h"
#include "service/failure_message.h"

namespace edgeslam {
namespace {

CommandOutcome save(const Map& map, const Camera& camera, const std::string& file) {
  try {
    saveMap(file, camera, map);
  } catch (const std::exception& error) {
    return {false, "the map is not saved: " + failureMessage(error)};
  }
  return {true, "map of " + std::to_string(map.keyframes.size()) + " keyframes and " +
                    std::to_string(map.points.size()) + " points saved to " + file};
}

}  // namespace

MapSaving::MapSaving(const Camera& camera, const std::string& file, bool is_frozen, CommandAnswers& answers,
                     BackgroundWork& disk_work, EventLog& log)
    : camera_(camera), file_(file), is_frozen_(is_frozen), answers_(answers), disk_work_(disk_work), log_(log) {}

void MapSaving::end() { answer(std::exchange(wishes_, {}), {false, "the run ended before the map could be saved"}); }

void MapSaving::ask(const std::optional<Command>& command) {
  assert(run_);
  if (file_.empty()) {
    return answer({command}, {false, is_frozen_ ? "the map is frozen (map.frozen): there is nothing new to save"
                                                : "no file is configured for the map (map.file)"});
  }
  wishes_.push_back(command);
  run_->askForMap();
}

void MapSaving::mapCame(const std::shared_ptr<const Map>& map) {
  if (wishes_.empty()) return;
  const Wishes wishes = std::exchange(wishes_, {});
  // What was saved before is worth more.
  if (map->points.empty()) return answer(wishes, {false, "there is no map yet"});
  disk_work_.begin([this, map, wishes, camera = camera_, file = file_]() -> BackgroundWork::Completion {
    return [this, wishes, outcome = save(*map, camera, file)] { answer(wishes, outcome); };
  });
}

void MapSaving::answer(const Wishes& wishes, const CommandOutcome& outcome) {
  if (!wishes.empty()) log_.tell(outcome.message);
  for (const std::optional<Command>& command : wishes) {
    if (command) answers_.answer(*command, outcome);
  }
}

}  // namespace edgeslam
