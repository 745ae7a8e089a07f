#include "service/daemon.h"

#include <chrono>
#include <new>
#include <utility>

#include "drivers/cameras/open_camera.h"
#include "map/saved_map.h"
#include "service/readout_check.h"

namespace edgeslam {
namespace {

constexpr auto longest_wait = std::chrono::milliseconds(100);  // for a frame, before signals and commands are seen to

}  // namespace

Daemon::Daemon(DaemonSetup setup, EventLog& log)
    : setup_(std::move(setup)),
      log_(log),
      deadline_(log),
      next_recording_(setup_.configuration, setup_.camera, link_, log) {
  for (const std::string& problem : startProblems(startNeeds(setup_))) log_.tell(problem);
  if (const std::string presumed = presumedLens(setup_.configuration); !presumed.empty()) log_.tell(presumed);
  openCamera();
  page_ = std::make_unique<DaemonPage>(setup_, camera_->stream().camera, signals_, log_);
  publisher_ = std::make_unique<RunPublisher>(publishingSetup(setup_, page_->viewer()), link_, log_);
  intake_ = std::make_unique<FrameIntake>(*camera_, link_, log_);
  openSensors();
  map_ = std::move(setup_.map_in);
  if (map_) start_ = RunStart::saved_map;
  beginRecording();
}

void Daemon::openCamera() {
  std::string problem;
  CameraOptions options = setup_.capture;
  options.readout_s = setup_.camera.readout_s;
  camera_ = openOrAwaitCamera(options, {setup_.camera.width, setup_.camera.height}, problem);
  link_.setCameraProblem(problem);
  const StreamDescription& stream = camera_->stream();
  log_.tell(problem.empty() ? "camera: " + stream.camera + ", " + stream.format : "waiting for the camera: " + problem);
}

void Daemon::openSensors() {
  const InertiaConfiguration& inertia = setup_.configuration.inertia;
  if (ImuReceiver* receiver = publisher_->imu()) {
    inertia_.emplace(SensorName{"inertial unit", "nothing that a unit measures"}, *receiver,
                     InertialWatch(inertia.unit.offset_ns), link_, log_);
  } else if (inertia.is_used) {
    tellUnheard("the inertial unit measures");
  }
  if (OdometryReceiver* receiver = publisher_->wheels()) {
    if (!setup_.configuration.settings.wheels.enabled) return;  // they are for the scale
    wheels_.emplace(SensorName{"wheels", "no pose of a body"}, *receiver, WheelWatch(), link_, log_);
  } else if (setup_.configuration.settings.wheels.enabled) {
    tellUnheard("the wheels say");
  }
}

void Daemon::tellUnheard(const char* what) {
  log_.tell(std::string("runs on without what ") + what + ", which cannot be received over " +
            effectiveUrl(setup_.configuration.service.lcm));
}

// Before the frame that follows them.
void Daemon::takeSensors(const Capture& captured, LiveRun& run) {
  if (inertia_) inertia_->take(captured, run);
  if (wheels_) wheels_->take(captured, run);
}

// From the start of the run to come.
void Daemon::beginRecording() {
  if (setup_.record_folder.empty()) {
    next_recording_.openWhereConfigured();
  } else {
    next_recording_.openTo(setup_.record_folder);
  }
  if (map_ && next_recording_.isOpen()) next_recording_.keepMap(*map_);
}

void Daemon::run() {
  publisher_->service().ready();
  if (setup_.for_viewing) {
    page_->waitUntilWatched();
    ended_ = signals_.end();
  } else {
    log_.tell(std::string("version ") + EDGESLAM_VERSION + " runs, poses go to " +
              effectiveUrl(setup_.configuration.service.lcm));
  }
  while (!ended_) oneRun();
}

void Daemon::oneRun() {
  std::shared_ptr<FlightRecorder> recorder = next_recording_.take();
  const Settings& settings = setup_.configuration.settings;
  LiveRun run(setup_.camera, settings, liveOptions(settings.threads), publisher_->observer(), recorder.get());
  if (map_) run.goOnWith(std::move(*map_));
  map_.reset();
  publisher_->begin(run, recorder, start_);
  camera_->keepJpeg(recorder != nullptr);
  run.start();
  if (!std::exchange(processors_told_, true)) tellProcessorProblems(run);
  setUpThread({"capture", settings.threads.capture_priority, 0, false, {}});
  const RunEnd end = capture(run);
  if (signals_.end() || reserve_.isUsed()) deadline_.begin();
  setUpThread({"edgeslam", 0, 0, false, {}});  // for the threads to come
  if (!end.command) publisher_->service().stopping();
  run.stop(end.settles);
  publisher_->end(/*is_last=*/!end.command);
  recorder.reset();
  if (end.command) return beginNext(*end.command, run);
  ended_ = true;
  finish(run.mapper().map());
}

// Priorities and memory were told at the start, with what to do.
void Daemon::tellProcessorProblems(const LiveRun& run) {
  for (const RefusedSetup& problem : run.problems()) {
    if (problem.kind == SetupKind::processor) log_.tell("runs on without " + problem.text);
  }
}

// Of the camera that gave the first frame: it may have been waited for.
void Daemon::tellReadout() {
  const std::string line =
      readoutLine(setup_.camera.readout_s, setup_.configuration.has_readout, camera_->stream().readout_s);
  if (!line.empty()) log_.tell(line);
}

Daemon::RunEnd Daemon::capture(LiveRun& run) {
  while (!signals_.end() && !reserve_.isUsed()) {
    if (signals_.takeMapWish()) link_.askForMapToBeSaved();
    if (next_recording_.isUnderway()) {
      next_recording_.seeToPreparation();
    } else if (const std::optional<Command> command = link_.takeRequest()) {
      next_recording_.prepareFor(*command);
    }
    if (const std::optional<Command> prepared = next_recording_.takePrepared()) return {prepared};
    const Capture captured = camera_->next(run.nextSlot().grey, longest_wait);
    if (captured.event == CaptureEvent::ended) {
      log_.tell(camera_->stream().camera + ": at its end");
      return {std::nullopt, true};
    }
    takeSensors(captured, run);
    intake_->take(captured, run);
    if (captured.event == CaptureEvent::frame && !std::exchange(readout_told_, true)) tellReadout();
  }
  return {};
}

// A recording repeats a run only from its start: the run to come continues the map of the one before, which is kept
// with the recording.
void Daemon::beginNext(const Command& command, LiveRun& run) {
  if (command.kind == CommandKind::reset && setup_.configuration.settings.tracking.map_is_frozen) {
    start_ = RunStart::saved_map;
    map_ = run.mapper().map();
    log_.tell("begun anew in the map, which is frozen");
    return link_.answer(command, true, "begun anew in the map, which is frozen");
  }
  if (command.kind == CommandKind::reset) {
    start_ = RunStart::new_map;
    log_.tell("the map is forgotten, begun anew");
    return link_.answer(command, true, "begun anew");
  }
  const bool has_map = !run.mapper().map().points.empty();
  start_ = has_map ? RunStart::same_map : RunStart::new_map;
  if (has_map) {
    map_ = run.mapper().map();
    next_recording_.keepMap(*map_);
  }
  link_.answer(command, true, "recording to " + next_recording_.folder());
}

void Daemon::finish(const Map& map) {
  if (setup_.for_viewing && !signals_.end() && !reserve_.isUsed()) {
    page_->showUntilSignal(map);
    deadline_.begin();
  }
  if (!setup_.map_out.empty()) writeMap(map);
  const PublisherStatus totals = publisher_->status();
  log_.tell("ended after " + std::to_string(totals.frames_captured) + " frames, " +
            std::to_string(totals.frames_dropped) + " of them dropped, " + std::to_string(totals.frames_unreadable) +
            " unreadable");
  if (reserve_.isUsed()) throw std::bad_alloc();
}

void Daemon::writeMap(const Map& map) {
  if (map.points.empty()) return log_.tell(setup_.map_out + " is not written: no map came to stand");
  saveMap(setup_.map_out, setup_.camera, map);
  log_.tell("map of " + std::to_string(map.keyframes.size()) + " keyframes saved to " + setup_.map_out);
}

}  // namespace edgeslam
