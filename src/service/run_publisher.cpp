#include "service/run_publisher.h"

#include <utility>

namespace edgeslam {
namespace {

// What matters of the state for those who read the log.
std::string stateText(TrackingState state, const std::string& reason) {
  if (isGoodPose(state)) return "tracking";
  if (state == TrackingState::predicted) return "";  // of one frame; told where it stays
  return stateName(state) + (reason.empty() ? "" : ", " + reason);
}

std::string serviceText(const PublisherStatus& status, TrackingState state, bool with_gaps) {
  if (!status.camera_problem.empty()) return "no camera: " + status.camera_problem;
  return std::string(stateName(state)) + ", " + std::to_string(status.keyframes) + " keyframes, " +
         std::to_string(status.points) + " points" + (status.recording ? ", recording" : "") +
         (with_gaps ? " with gaps" : "");
}

}  // namespace

PublishingSetup publishingSetup(const Configuration& configuration, const Camera& camera) {
  const ServiceOptions& service = configuration.service;
  PublishingSetup setup;
  setup.lcm = service.lcm;
  setup.lcm.real_time_priority = configuration.settings.threads.publishing_priority;
  setup.map_interval_s = service.map_interval_s;
  setup.body_T_camera = configuration.body_T_camera;
  setup.camera = camera;
  setup.scale = service.scale;
  if (service.scale.source == "odometry") setup.lcm.wheels_channel = service.scale.odometry.channel;
  return setup;
}

RunPublisher::RunPublisher(const PublishingSetup& setup, CaptureLink& link, EventLog& log)
    : setup_(setup),
      link_(link),
      log_(log),
      publisher_(setup.lcm, setup.body_T_camera),
      search_(setup.scale, setup.body_T_camera) {}

void RunPublisher::begin(LiveRun& run, std::shared_ptr<FlightRecorder> recorder, RunStart start) {
  run_ = &run;
  recorder_ = std::move(recorder);
  told_recording_ = isRecording();
  told_gaps_ = false;
  published_changes_ = 0;
  shown_changes_ = -1;
  if (setup_.viewer) run.showTo(setup_.viewer->looks());
  if (start == RunStart::same_map) return;
  forgetScale();
  if (start == RunStart::saved_map && setup_.scale.metres_per_unit > 0) {
    scale_ = ScaleKind::known_distance;
    publisher_.setScale({scale_, setup_.scale.metres_per_unit, setup_.scale.sigma});
  }
}

void RunPublisher::end(bool is_last) {
  work_.finish();
  work_.complete();
  answerSaves(std::exchange(save_wishes_, {}), false, "the run ended before the map could be saved");
  if (told_recording_) endRecording({});
  recorder_.reset();
  if (is_last) disk_work_.finish();
  disk_work_.complete();
  const PublisherStatus last = status();
  publisher_.status(last);
  showStatus(last);
  tellChanges(last);
  map_wanted_ = ground_wanted_ = false;
  earlier_runs_ = countsOverRuns();
  run_ = nullptr;
}

LiveObserver RunPublisher::observer() {
  LiveObserver observer;
  observer.frame = [this](const FrameResult& result, const std::string& problem) { frame(result, problem); };
  observer.report = [this](const MappingReport& done) { report(done); };
  observer.tick = [this] { tick(); };
  return observer;
}

void RunPublisher::frame(const FrameResult& result, const std::string& problem) {
  const bool is_initialising = result.state == TrackingState::initialising;
  if (is_initialising && (state_ != TrackingState::initialising || scale_ != ScaleKind::unknown)) forgetScale();
  publisher_.frame(result);
  if (setup_.viewer) setup_.viewer->frame(result);
  service_.alive(Clock::now());
  history_.add(result);
  takeOdometry();
  search_.add(result);
  if (!problem.empty()) ++unreadable_;
  state_ = result.state;
  reason_ = result.reason;
}

void RunPublisher::report(const MappingReport& report) {
  if (report.found) ++(report.found->how == TrackingState::recovered ? recoveries_ : relocalisations_);
  if (report.loop) {
    ++loops_;
    mapWasCorrected();
  }
  if (report.found || report.loop) {
    for (const std::string& event : report.events) {
      log_.tell("frame " + std::to_string(report.frame_index) + ": " + event);
    }
  }
  if (report.map) mapCame(report.map);
}

void RunPublisher::tick() {
  const Clock::time_point now = Clock::now();
  work_.complete();
  disk_work_.complete();
  for (const CaptureLink::Answer& given : link_.takeAnswers()) {
    answer(given.command, given.accepted, given.message);
  }
  if (link_.takeMapWish()) askToSaveMap({});
  while (const std::optional<Command> command = publisher_.nextCommand()) carryOut(*command);
  while (const std::optional<Command> command = setup_.viewer ? setup_.viewer->nextCommand() : std::nullopt) {
    carryOut(*command);
  }
  if (const std::int64_t waits = link_.waits(); waits != waits_) {
    waits_ = waits;
    service_.alive(now);
  }
  takeOdometry();
  if (now >= next_second_) eachSecond(now);
}

void RunPublisher::eachSecond(Clock::time_point now) {
  next_second_ = std::max(next_second_ + std::chrono::seconds(1), now);
  followScale(now);
  const PublisherStatus current = status();
  publisher_.status(current);
  showStatus(current);
  service_.status(serviceText(current, state_, recordsWithGaps()));
  tellChanges(current);
  publishChangedMap(now);
  showChangedMap(now);
}

void RunPublisher::showStatus(const PublisherStatus& status) {
  if (setup_.viewer) setup_.viewer->status(status, publisher_.scale(), publisher_.problem());
}

PublisherStatus RunPublisher::status() const {
  const LiveCounts counts = countsOverRuns();
  PublisherStatus status;
  status.uptime_ms = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - start_).count();
  status.version = EDGESLAM_VERSION;
  status.frames_captured = counts.captured;
  status.frames_dropped = counts.passed_over + link_.lost();
  status.frames_unreadable = unreadable_;
  status.results_not_published = counts.not_published;
  status.recoveries = recoveries_;
  status.relocalisations = relocalisations_;
  status.loops = loops_;
  status.mapping_queue = static_cast<int>(counts.messages_waiting);
  status.publishing_queue = static_cast<int>(counts.results_waiting);
  status.keyframes = static_cast<int>(counts.keyframes);
  status.points = static_cast<int>(counts.points);
  status.recording = isRecording();
  status.camera_problem = link_.cameraProblem();
  status.scale_problem = scaleProblem();
  return status;
}

// At most a line of each kind a second.
void RunPublisher::tellChanges(const PublisherStatus& status) {
  const std::string state = stateText(state_, reason_);
  if (!state.empty() && state != told_state_ && status.frames_captured > 0) {
    told_state_ = state;
    log_.tell("state: " + state);
  }
  const std::string problem = publisher_.problem();
  if (problem != told_lcm_problem_) {
    log_.tell(problem.empty() ? "messages go out again" : "messages do not go out: " + problem);
    told_lcm_problem_ = problem;
  }
  if (told_recording_ && !status.recording && recorder_) log_.tell(recorder_->status().message);
  told_recording_ = status.recording;
  if (!told_gaps_ && recordsWithGaps()) {
    told_gaps_ = true;
    log_.tell("recording to " + recorder_->folder() + ", with gaps: it will not repeat the run");
  }
}

// Counters of the runs before are in; what is of now is of this run.
LiveCounts RunPublisher::countsOverRuns() const {
  LiveCounts counts = run_ ? run_->counts() : LiveCounts();
  counts.captured += earlier_runs_.captured;
  counts.processed += earlier_runs_.processed;
  counts.passed_over += earlier_runs_.passed_over;
  counts.mapping_behind += earlier_runs_.mapping_behind;
  counts.not_published += earlier_runs_.not_published;
  return counts;
}

bool RunPublisher::isRecording() const { return recorder_ && recorder_->status().recording; }

bool RunPublisher::recordsWithGaps() const { return isRecording() && recorder_->status().not_recorded > 0; }

}  // namespace edgeslam
