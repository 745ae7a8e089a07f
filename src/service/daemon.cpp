#include "service/daemon.h"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <utility>

#include "drivers/cameras/open_camera.h"
#include "drivers/lcm/start_check.h"
#include "map/saved_map.h"
#include "service/failure_message.h"

namespace edgeslam {
namespace {

constexpr auto longest_wait = std::chrono::milliseconds(100);  // for a frame, before signals and commands are seen to
constexpr auto longest_preparation = std::chrono::seconds(3);  // of a recording, by the disk

// Of a recording that comes too late.
BackgroundWork::Completion discard(FlightRecorder& recorder) {
  recorder.stop();
  std::error_code ignored;
  std::filesystem::remove_all(recorder.folder(), ignored);
  return {};
}

PublishingSetup publishingOf(const DaemonSetup& setup, Viewer* viewer) {
  PublishingSetup publishing = publishingSetup(setup.configuration, setup.camera);
  publishing.viewer = viewer;
  publishing.map_file = setup.map_out;
  publishing.begins_anew = true;
  return publishing;
}

}  // namespace

Daemon::Daemon(DaemonSetup setup, EventLog& log) : setup_(std::move(setup)), log_(log) {
  tellStartProblems();
  std::string problem;
  camera_ = openOrAwaitCamera(setup_.capture, {setup_.camera.width, setup_.camera.height}, problem);
  link_.setCameraProblem(problem);
  const StreamDescription& stream = camera_->stream();
  log_.tell(problem.empty() ? "camera: " + stream.camera + ", " + stream.format : "waiting for the camera: " + problem);
  if (setup_.configuration.service.viewer.enabled) openViewer();
  publisher_ = std::make_unique<RunPublisher>(publishingOf(setup_, viewer_.get()), link_, log_);
  map_ = std::move(setup_.map_in);
  if (map_) start_ = RunStart::saved_map;
  if (!setup_.record_folder.empty()) {
    next_recorder_ = recordTo(setup_.record_folder);
    if (map_) saveMapAtStart(*map_, setup_.record_folder);
  } else {
    recordWhereConfigured();
  }
}

void Daemon::tellStartProblems() {
  const ServiceOptions& service = setup_.configuration.service;
  const ThreadOptions& threads = setup_.configuration.settings.threads;
  StartNeeds needs;
  needs.lcm_url = effectiveUrl(service.lcm);
  needs.real_time_priority =
      std::max({threads.capture_priority, threads.tracking_priority, threads.publishing_priority});
  needs.lock_memory = threads.lock_memory;
  needs.folder = service.recordings_folder;
  if (needs.folder.empty() && !setup_.map_out.empty()) {
    needs.folder = std::filesystem::absolute(setup_.map_out).parent_path().string();
  }
  for (const std::string& problem : startProblems(needs)) log_.tell(problem);
}

// Priorities and memory were told at the start, with what to do.
void Daemon::tellProcessorProblems(const LiveRun& run) {
  for (const RefusedSetup& problem : run.problems()) {
    if (problem.kind == SetupKind::processor) log_.tell("runs on without " + problem.text);
  }
}

void Daemon::run() {
  publisher_->service().ready();
  if (setup_.for_viewing) {
    waitForViewer();
  } else {
    log_.tell(std::string("version ") + EDGESLAM_VERSION + " runs, poses go to " +
              effectiveUrl(setup_.configuration.service.lcm));
  }
  while (!ended_) oneRun();
}

void Daemon::oneRun() {
  recorder_ = std::exchange(next_recorder_, nullptr);
  const Settings& settings = setup_.configuration.settings;
  LiveRun run(setup_.camera, settings, liveOptions(settings.threads), publisher_->observer(), recorder_.get());
  if (map_) run.goOnWith(std::move(*map_));
  map_.reset();
  publisher_->begin(run, recorder_, start_);
  run.start();
  if (!std::exchange(processors_told_, true)) tellProcessorProblems(run);
  setUpThread({"capture", settings.threads.capture_priority, 0, false, {}});
  const RunEnd end = capture(run);
  setUpThread({"edgeslam", 0, 0, false, {}});  // for the threads to come
  if (!end.command) publisher_->service().stopping();
  run.stop(end.settles);
  publisher_->end(/*is_last=*/!end.command);
  recorder_.reset();
  if (end.command) return beginNext(*end.command, run);
  ended_ = true;
  if (setup_.for_viewing && !signals_.end()) showUntilSignal(run.mapper().initialised() ? run.mapper().map() : Map());
  if (!setup_.map_out.empty()) writeMap(run.mapper().initialised() ? run.mapper().map() : Map());
  const PublisherStatus totals = publisher_->status();
  log_.tell("ended after " + std::to_string(totals.frames_captured) + " frames, " +
            std::to_string(totals.frames_dropped) + " of them dropped, " + std::to_string(totals.frames_unreadable) +
            " unreadable");
}

Daemon::RunEnd Daemon::capture(LiveRun& run) {
  while (!signals_.end()) {
    if (signals_.takeMapWish()) link_.askForMapToBeSaved();
    if (preparation_) {
      seeToPreparation();
    } else if (const std::optional<Command> command = link_.takeRequest()) {
      prepare(*command);
    }
    if (prepared_) return {std::exchange(prepared_, std::nullopt)};
    const Capture captured = camera_->next(run.nextSlot().grey, longest_wait);
    if (captured.event == CaptureEvent::ended) {
      log_.tell(camera_->stream().camera + ": at its end");
      return {std::nullopt, true};
    }
    take(captured, run);
  }
  return {};
}

void Daemon::take(const Capture& captured, LiveRun& run) {
  switch (captured.event) {
    case CaptureEvent::frame: {
      if (captured.frame.after_interruption) {
        log_.tell(camera_->stream().camera + ": gives frames, " + camera_->stream().format);
        link_.setCameraProblem("");
      }
      damage_told_ = damage_told_ && !captured.frame.after_interruption;
      FrameSlot& slot = run.nextSlot();
      slot.index = index_ = std::max(index_ + 1, captured.frame.sequence);
      slot.time_ns = time_ns_ = captured.frame.time_ns;
      slot.problem.clear();
      run.handOver();
      return link_.lost(captured.frame.lost_before + captured.frame.passed_over_before);
    }
    case CaptureEvent::damaged_frame:
      return takeDamaged(captured, run);
    case CaptureEvent::interrupted:
      log_.tell(captured.message);
      return link_.setCameraProblem(captured.message);
    case CaptureEvent::none_yet:
      if (!camera_->isOpen() || camera_->stream().is_recording) link_.waited();
      return;
    case CaptureEvent::ended:
      return;
  }
}

// A frame that came and cannot be used; one without a time stamp of its own is only counted.
void Daemon::takeDamaged(const Capture& captured, LiveRun& run) {
  if (!std::exchange(damage_told_, true)) log_.tell(captured.message + " (more of them are only counted)");
  if (captured.frame.time_ns <= time_ns_) return link_.lost(1);
  FrameSlot& slot = run.nextSlot();
  slot.index = index_ = std::max(index_ + 1, captured.frame.sequence);
  slot.time_ns = time_ns_ = captured.frame.time_ns;
  slot.problem = captured.message;
  run.handOver();
  link_.lost(captured.frame.lost_before + captured.frame.passed_over_before);
}

// The run goes on until the disk, which may be slow, has the folder of the next one's recording.
void Daemon::prepare(const Command& command) {
  if (command.kind == CommandKind::reset && !setup_.configuration.service.records_from_start) {
    prepared_ = command;
    return;
  }
  preparation_ = {command, std::chrono::steady_clock::now() + longest_preparation};
  disk_work_.begin([this, command, given_up = preparation_->given_up]() -> BackgroundWork::Completion {
    if (*given_up) return {};
    try {
      std::shared_ptr<FlightRecorder> recorder = openRecording(nextRecordingFolder());
      if (*given_up) return discard(*recorder);
      return [this, command, given_up, recorder] {
        if (*given_up) return disk_work_.begin([recorder] { return discard(*recorder); });
        preparation_.reset();
        log_.tell(recorder->status().message);
        next_recorder_ = recorder;
        prepared_ = command;
      };
    } catch (const std::exception& error) {
      return [this, command, given_up, problem = failureMessage(error)] {
        if (!*given_up) cannotRecord(command, problem);
      };
    }
  });
}

void Daemon::seeToPreparation() {
  disk_work_.complete();
  if (!preparation_ || std::chrono::steady_clock::now() < preparation_->until) return;
  *preparation_->given_up = true;
  const std::string& folder = setup_.configuration.service.recordings_folder;
  cannotRecord(Command(preparation_->command), folder + ": the disk does not answer");
}

// Which is no reason not to begin anew.
void Daemon::cannotRecord(const Command& command, const std::string& problem) {
  preparation_.reset();
  log_.tell("no recording: " + problem);
  if (command.kind == CommandKind::reset) {
    prepared_ = command;
  } else {
    link_.answer(command, false, problem);
  }
}

// A recording repeats a run only from its start: the run to come goes on with the map of the one before, which is kept
// with the recording.
void Daemon::beginNext(const Command& command, LiveRun& run) {
  if (command.kind == CommandKind::reset) {
    start_ = RunStart::new_map;
    log_.tell("the map is forgotten, begun anew");
    return link_.answer(command, true, "begun anew");
  }
  const bool has_map = run.mapper().initialised() && !run.mapper().map().points.empty();
  start_ = has_map ? RunStart::same_map : RunStart::new_map;
  if (has_map) {
    map_ = run.mapper().map();
    saveMapAtStart(*map_, next_recorder_->folder());
  }
  link_.answer(command, true, "recording to " + next_recorder_->folder());
}

std::shared_ptr<FlightRecorder> Daemon::openRecording(const std::string& folder) const {
  const RecordingDescription description{setup_.camera, formatConfiguration(setup_.configuration), EDGESLAM_VERSION};
  return std::make_shared<FlightRecorder>(folder, description,
                                          recordingLimits(setup_.configuration.settings.recording));
}

std::shared_ptr<FlightRecorder> Daemon::recordTo(const std::string& folder) {
  std::shared_ptr<FlightRecorder> recorder = openRecording(folder);
  log_.tell(recorder->status().message);
  return recorder;
}

// From the start of the run to come. A disk that does not take it is told, and is no reason to give no poses.
void Daemon::recordWhereConfigured() {
  if (!setup_.configuration.service.records_from_start) return;
  try {
    next_recorder_ = recordTo(nextRecordingFolder());
    if (map_) saveMapAtStart(*map_, next_recorder_->folder());
  } catch (const InputError& error) {
    log_.tell(std::string("no recording: ") + error.what());
  }
}

// By the time (UTC): "recordings/20250131T235959Z", with a number where that is taken.
std::string Daemon::nextRecordingFolder() const {
  const std::string& parent = setup_.configuration.service.recordings_folder;
  if (parent.empty()) throw InputError("no folder is configured for recordings (recording.folder)");
  std::error_code error;
  std::filesystem::create_directories(parent, error);
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char stamp[32];
  std::strftime(stamp, sizeof(stamp), "%Y%m%dT%H%M%SZ", &utc);
  const std::string name = (std::filesystem::path(parent) / stamp).string();
  std::string folder = name;
  for (int number = 2; std::filesystem::exists(folder, error); ++number) folder = name + "-" + std::to_string(number);
  return folder;
}

void Daemon::saveMapAtStart(const Map& map, const std::string& folder) {
  disk_work_.begin([this, map = std::make_shared<const Map>(map), folder]() -> BackgroundWork::Completion {
    try {
      saveMap(folder + "/" + recording_map_name, setup_.camera, *map);
    } catch (const std::exception& error) {
      log_.tell("the recording will not repeat the run, its map is not with it: " + failureMessage(error));
    }
    return {};
  });
}

void Daemon::writeMap(const Map& map) {
  if (map.points.empty()) return log_.tell(setup_.map_out + " is not written: no map came to stand");
  saveMap(setup_.map_out, setup_.camera, map);
  log_.tell("map of " + std::to_string(map.keyframes.size()) + " keyframes saved to " + setup_.map_out);
}

}  // namespace edgeslam
