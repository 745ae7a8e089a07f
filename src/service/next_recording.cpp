#include "service/next_recording.h"

#include <cassert>
#include <exception>
#include <filesystem>
#include <utility>

#include "configuration/configuration_text.h"
#include "edgeslam/input_error.h"
#include "map/saved_map.h"
#include "service/failure_message.h"
#include "service/recording_folder.h"

namespace edgeslam {
namespace {

constexpr auto longest_preparation = std::chrono::seconds(3);  // by the disk

// Of a recording that comes too late.
BackgroundWork::Completion discard(FlightRecorder& recorder) {
  recorder.stop();
  std::error_code ignored;
  std::filesystem::remove_all(recorder.folder(), ignored);
  return {};
}

}  // namespace

void NextRecording::openTo(const std::string& folder) {
  recorder_ = open(folder);
  log_.tell(recorder_->status().message);
}

void NextRecording::openWhereConfigured() {
  if (!configuration_.service.records_from_start) return;
  try {
    openTo(nextRecordingFolder(configuration_.service.recordings_folder));
  } catch (const InputError& error) {
    log_.tell(std::string("no recording: ") + error.what());
  }
}

void NextRecording::prepareFor(const Command& command) {
  if (command.kind == CommandKind::reset && !configuration_.service.records_from_start) {
    prepared_ = command;
    return;
  }
  preparation_ = {command, std::chrono::steady_clock::now() + longest_preparation};
  disk_work_.begin([this, command, given_up = preparation_->given_up] { return openInBackground(command, given_up); });
}

BackgroundWork::Completion NextRecording::openInBackground(const Command& command,
                                                           const std::shared_ptr<std::atomic<bool>>& given_up) {
  if (*given_up) return {};
  try {
    std::shared_ptr<FlightRecorder> recorder = open(nextRecordingFolder(configuration_.service.recordings_folder));
    if (*given_up) return discard(*recorder);
    return [this, command, given_up, recorder] {
      if (*given_up) return disk_work_.begin([recorder] { return discard(*recorder); });
      preparation_.reset();
      log_.tell(recorder->status().message);
      recorder_ = recorder;
      prepared_ = command;
    };
  } catch (const std::exception& error) {
    return [this, command, given_up, problem = failureMessage(error)] {
      if (!*given_up) cannotRecord(command, problem);
    };
  }
}

void NextRecording::seeToPreparation() {
  disk_work_.complete();
  if (!preparation_ || std::chrono::steady_clock::now() < preparation_->until) return;
  *preparation_->given_up = true;
  const std::string& folder = configuration_.service.recordings_folder;
  cannotRecord(Command(preparation_->command), folder + ": the disk does not answer");
}

// Which is no reason not to begin anew.
void NextRecording::cannotRecord(const Command& command, const std::string& problem) {
  preparation_.reset();
  log_.tell("no recording: " + problem);
  if (command.kind == CommandKind::reset) {
    prepared_ = command;
  } else {
    link_.answer(command, false, problem);
  }
}

std::optional<Command> NextRecording::takePrepared() { return std::exchange(prepared_, std::nullopt); }

const std::string& NextRecording::folder() const {
  assert(recorder_);
  return recorder_->folder();
}

void NextRecording::keepMap(const Map& map) {
  disk_work_.begin([this, map = std::make_shared<const Map>(map), folder = folder()]() -> BackgroundWork::Completion {
    try {
      saveMap(folder + "/" + recording_map_name, camera_, *map);
    } catch (const std::exception& error) {
      log_.tell("the recording will not repeat the run, its map is not with it: " + failureMessage(error));
    }
    return {};
  });
}

std::shared_ptr<FlightRecorder> NextRecording::take() { return std::exchange(recorder_, nullptr); }

std::shared_ptr<FlightRecorder> NextRecording::open(const std::string& folder) const {
  const RecordingDescription description{camera_, formatRecordedConfiguration(configuration_), EDGESLAM_VERSION};
  return std::make_shared<FlightRecorder>(folder, description, recordingLimits(configuration_.settings.recording));
}

}  // namespace edgeslam
