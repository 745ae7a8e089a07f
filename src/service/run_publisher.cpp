#include "service/run_publisher.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "service/status_text.h"

namespace edgeslam {
namespace {

std::unique_ptr<Ros2Publisher> wantedRos2(const PublishingSetup& setup) {
  if (!setup.ros2.enabled) return nullptr;
  return std::make_unique<Ros2Publisher>(setup.ros2, setup.lcm.real_time_priority);
}

}  // namespace

RunPublisher::RunPublisher(const PublishingSetup& setup, CaptureLink& link, EventLog& log)
    : viewer_(setup.viewer),
      link_(link),
      publisher_(setup.lcm, setup.body_T_camera),
      ros2_(wantedRos2(setup)),
      answers_(publisher_, viewer_),
      scale_(setup.scale, setup.body_T_camera, publisher_, work_, log),
      map_(setup.camera, setup.map_interval_s, publisher_, ros2_.get(), viewer_, work_),
      saving_(setup.camera, setup.map_file, setup.map_is_frozen, answers_, disk_work_, log),
      recording_(answers_, disk_work_, log),
      commands_({link_, map_, saving_, recording_, scale_}, answers_, setup.begins_anew),
      log_(log) {}

void RunPublisher::begin(LiveRun& run, std::shared_ptr<FlightRecorder> recorder, RunStart start) {
  run_ = &run;
  totals_.begin(run);
  recording_.begin(std::move(recorder));
  map_.begin(run);
  saving_.begin(run);
  if (viewer_) run.showTo(viewer_->looks());
  if (start != RunStart::same_map) {
    scale_.forget();
    worlds_.begin();
  }
  if (start == RunStart::saved_map) scale_.takeConfigured();
}

void RunPublisher::end(bool is_last) {
  assert(run_);
  work_.finish();
  work_.complete();
  saving_.end();
  recording_.end();
  if (is_last) disk_work_.finish();
  disk_work_.complete();
  const PublisherStatus last = status();
  giveOut(last);
  tellChanges(last);
  map_.end();
  scale_.runEnded();
  totals_.end();
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
  if (is_initialising && (state_ != TrackingState::initialising || scale_.isKnown())) scale_.noMap();
  scale_.beforeFrame(result);
  const SentFrame sent = publisher_.frame(result);
  if (ros2_) ros2_->frame(sent);
  if (viewer_) viewer_->frame(result);
  service_.alive(Clock::now());
  scale_.frame(result);
  if (const std::optional<std::string> change = worlds_.frame(result)) log_.tellWorld(result.index, *change);
  map_.enterWorld(worlds_.world());
  totals_.frame(/*is_readable=*/problem.empty());
  state_ = result.state;
  reason_ = result.reason;
}

void RunPublisher::report(const MappingReport& report) {
  totals_.report(report);
  if (report.loop) scale_.mapWasCorrected();
  if (report.lacking_for_metres) scale_.mapLacks(*report.lacking_for_metres);
  log_.report(report);
  if (!report.map) return;
  map_.mapCame(report.map);
  scale_.mapCame(report.map);
  saving_.mapCame(report.map);
}

void RunPublisher::tick() {
  const Clock::time_point now = Clock::now();
  work_.complete();
  disk_work_.complete();
  carryOutCommands();
  if (const std::int64_t waits = link_.waits(); waits != waits_) {
    waits_ = waits;
    service_.alive(now);
  }
  scale_.takeOdometry();
  if (now >= next_second_) eachSecond(now);
}

void RunPublisher::carryOutCommands() {
  commands_.passOnAnswers();
  if (link_.takeMapWish()) saving_.ask({});
  while (const std::optional<Command> command = publisher_.nextCommand()) commands_.carryOut(*command);
  while (const std::optional<Command> command = viewer_ ? viewer_->nextCommand() : std::nullopt) {
    commands_.carryOut(*command);
  }
}

void RunPublisher::eachSecond(Clock::time_point now) {
  next_second_ = std::max(next_second_ + std::chrono::seconds(1), now);
  const double seconds = std::chrono::duration<double>(now - start_).count();
  if (scale_.everySecond(seconds, run_->counts().points > 0)) run_->askForMap();
  const PublisherStatus current = status();
  giveOut(current);
  service_.status(serviceText(current, state_, recording_.hasGaps()));
  tellChanges(current);
  map_.everySecond(now);
}

void RunPublisher::giveOut(const PublisherStatus& status) {
  const status_t sent = publisher_.status(status);
  if (ros2_) ros2_->status(sent, publisher_.scale());
  if (viewer_) viewer_->status(status, publisher_.scale(), publisher_.problem());
}

void RunPublisher::tellChanges(const PublisherStatus& status) {
  log_.tellChanges(status.frames_captured > 0 ? logText(state_, reason_) : "", publisher_.problem());
  while (const std::optional<std::string> event = ros2_ ? ros2_->nextEvent() : std::nullopt) log_.tellRos2(*event);
  recording_.tellChanges(status.recording);
}

PublisherStatus RunPublisher::status() const {
  PublisherStatus status;
  totals_.fill(status);
  status.worlds = worlds_.count();
  status.uptime_ms = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - start_).count();
  status.version = EDGESLAM_VERSION;
  status.frames_dropped += link_.lost();
  status.recording = recording_.goesOn();
  status.camera_problem = link_.cameraProblem();
  status.scale_problem = link_.sensorProblem();
  if (status.scale_problem.empty()) status.scale_problem = scale_.problem();
  return status;
}

}  // namespace edgeslam
