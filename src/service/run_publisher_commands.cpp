// The robot's commands, and the map as messages and file.
#include <utility>

#include "map/saved_map.h"
#include "pipeline/map_records.h"
#include "service/failure_message.h"
#include "service/run_publisher.h"

namespace edgeslam {
namespace {

constexpr auto shown_map_interval = std::chrono::seconds(2);

std::vector<PublishedPoint> publishedPoints(const Map& map, const Camera& camera) {
  std::vector<PublishedPoint> points;
  for (const MapPointRecord& record : mapPointRecords(map, camera)) {
    points.push_back({record.id, record.position.cast<float>(), record.edge_direction.cast<float>()});
  }
  return points;
}

// Whether it was saved, and in words.
std::pair<bool, std::string> save(const Map& map, const Camera& camera, const std::string& path) {
  try {
    saveMap(path, camera, map);
  } catch (const std::exception& error) {
    return {false, "the map is not saved: " + failureMessage(error)};
  }
  return {true, "map of " + std::to_string(map.keyframes.size()) + " keyframes and " +
                    std::to_string(map.points.size()) + " points saved to " + path};
}

}  // namespace

void RunPublisher::carryOut(const Command& command) {
  switch (command.kind) {
    case CommandKind::reset:
      return passToCapture(command);
    case CommandKind::save_map:
      return askToSaveMap({command});
    case CommandKind::start_recording:
      if (!isRecording()) return passToCapture(command);
      return answer(command, false, recorder_->status().message + " already");
    case CommandKind::stop_recording:
      return stopRecording(command);
    case CommandKind::set_scale:
      return setScale(command);
    case CommandKind::send_map:
      map_wanted_ = true;
      run_->askForMap();
      return answer(command, true, "the map follows");
  }
}

void RunPublisher::answer(const Command& command, bool accepted, const std::string& message) {
  if (command.sender == CommandSender::robot) return publisher_.answer(command, accepted, message);
  if (setup_.viewer) setup_.viewer->answer(command, accepted, message);
}

void RunPublisher::passToCapture(const Command& command) {
  if (!setup_.begins_anew) {
    answer(command, false, "a replay does not begin anew");
  } else if (!link_.request(command) && !link_.isUnderway(command)) {
    answer(command, false, "another command is still being carried out; send it again");
  }
}

void RunPublisher::stopRecording(const Command& command) {
  if (!isRecording()) return answer(command, false, "there is no recording");
  endRecording(command);
}

// Of a command or, without one, with its run.
void RunPublisher::endRecording(const std::optional<Command>& command) {
  told_recording_ = false;  // it is told here
  disk_work_.begin([this, command, recorder = std::exchange(recorder_, nullptr)]() -> BackgroundWork::Completion {
    const std::string message = recorder->stop().message;
    return [this, command, message] {
      log_.tell(message);
      if (command) answer(*command, true, message);
    };
  });
}

void RunPublisher::askToSaveMap(const MapSaveWish& wish) {
  if (setup_.map_file.empty()) {
    return answerSaves({wish}, false, "no file is configured for the map (map.file)");
  }
  save_wishes_.push_back(wish);
  run_->askForMap();
}

void RunPublisher::publishChangedMap(Clock::time_point now) {
  const LiveCounts counts = run_->counts();
  if (setup_.map_interval_s <= 0 || now < next_map_ || counts.points == 0 || counts.map_changes == published_changes_) {
    return;
  }
  next_map_ = now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(setup_.map_interval_s));
  published_changes_ = counts.map_changes;
  map_wanted_ = true;
  run_->askForMap();
}

// While someone looks on.
void RunPublisher::showChangedMap(Clock::time_point now) {
  if (!setup_.viewer || !setup_.viewer->isWatched()) {
    shown_changes_ = -1;
    return;
  }
  const std::int64_t changes = run_->counts().map_changes;
  if (changes == shown_changes_ || now < next_shown_map_) return;
  next_shown_map_ = now + shown_map_interval;
  shown_changes_ = changes;
  run_->askForMap();
}

void RunPublisher::mapCame(const MapPointer& map) {
  if (setup_.viewer) setup_.viewer->map(map);
  if (std::exchange(map_wanted_, false)) {
    work_.begin([this, map, version = ++map_version_]() -> BackgroundWork::Completion {
      return [this, version, points = publishedPoints(*map, setup_.camera)]() mutable {
        publisher_.map(version, std::move(points));
      };
    });
  }
  if (std::exchange(ground_wanted_, false)) lookForGround(map);
  if (!save_wishes_.empty()) saveMapInBackground(map);
}

void RunPublisher::saveMapInBackground(const MapPointer& map) {
  const std::vector<MapSaveWish> wishes = std::exchange(save_wishes_, {});
  // What was saved before is worth more.
  if (map->points.empty()) return answerSaves(wishes, false, "there is no map yet");
  disk_work_.begin([this, map, wishes]() -> BackgroundWork::Completion {
    return [this, wishes, outcome = save(*map, setup_.camera, setup_.map_file)] {
      answerSaves(wishes, outcome.first, outcome.second);
    };
  });
}

void RunPublisher::answerSaves(const std::vector<MapSaveWish>& wishes, bool saved, const std::string& message) {
  if (!wishes.empty()) log_.tell(message);
  for (const MapSaveWish& wish : wishes) {
    if (wish.command) answer(*wish.command, saved, message);
  }
}

}  // namespace edgeslam
