// What each thread of a live run does.
#include <cerrno>
#include <chrono>
#include <utility>

#include "pipeline/live_run.h"

namespace edgeslam {
namespace {

constexpr auto idle_time = std::chrono::milliseconds(1);
constexpr std::int64_t tick_interval_ns = 100'000'000;
constexpr std::size_t most_waiting_for_a_map = 3;
constexpr std::size_t least_room = 8;  // in mapping's queue, for a frame to tell it anything

void waitFor(sem_t& semaphore) {
  while (sem_wait(&semaphore) != 0 && errno == EINTR) {
  }
}

// Until the steady clock says so, at the latest.
void waitFor(sem_t& semaphore, std::int64_t until_ns) {
  constexpr std::int64_t second_ns = 1'000'000'000;
  const timespec until{static_cast<time_t>(until_ns / second_ns), static_cast<long>(until_ns % second_ns)};
  while (sem_clockwait(&semaphore, CLOCK_MONOTONIC, &until) != 0 && errno == EINTR) {
  }
}

}  // namespace

// Tracking's thread.

void LiveRun::track() {
  while (true) {
    waitFor(frame_ready_);
    const bool stopping = stopping_.load(std::memory_order_acquire) != Stopping::no;
    if (frames_.take()) trackFrame(frames_.reading());
    if (stopping) break;
  }
  tracking_ended_.store(true, std::memory_order_release);
}

void LiveRun::trackFrame(FrameSlot& slot) {
  durations_.waiting_for_tracking.add(steadyNow_ns() - slot.handed_over_ns);
  const Measured measured(durations_.tracking);
  PassedOverFrame passed_over;
  while (frames_.nextPassedOver(passed_over)) {
    passed_over_.fetch_add(1, std::memory_order_relaxed);
    if (sink_) sink_->passedOver(passed_over.index, passed_over.time_ns);
  }
  takeUpdate(slot.index);
  const bool mapping_busy = isMappingBusy();
  if (mapping_busy) mapping_behind_.fetch_add(1, std::memory_order_relaxed);
  if (mapping_busy && sink_) sink_->mappingBusy(slot.index);
  new_messages_.clear();
  const FrameResult& result = slot.problem.empty()
                                  ? tracking_.process(slot.index, slot.time_ns, slot.grey, mapping_busy, new_messages_)
                                  : tracking_.skip(slot.index, slot.time_ns, slot.problem);
  if (Published* published = results_.claim()) {
    published->result = result;
    published->result.latency_ms = static_cast<double>(steadyNow_ns() - slot.handed_over_ns) * 1e-6;
    published->problem = slot.problem;
    published->sent_ns = steadyNow_ns();
    results_.send(published);
    sem_post(&result_ready_);
  } else {
    not_published_.fetch_add(1, std::memory_order_relaxed);
  }
  for (MappingMessage& message : new_messages_) {
    MappingMessage* sent = messages_.claim();
    std::swap(*sent, message);
    sent->sent_ns = steadyNow_ns();
    messages_.send(sent);
  }
  if (sink_ && slot.problem.empty()) sink_->processed(tracking_.images());
  if (sink_ && !slot.problem.empty()) sink_->unreadable(slot.index, slot.time_ns, slot.problem);
  if (looks_ && slot.problem.empty()) looks_->show(result, tracking_.tracker());
  processed_.fetch_add(1, std::memory_order_relaxed);
}

// Before the map stands, what mapping makes of a frame is of use for as long as the first frame's points are in view.
bool LiveRun::isMappingBusy() const {
  if (!tracking_.hasMap()) return messages_.waiting() > most_waiting_for_a_map;
  return messages_.room() < least_room;
}

void LiveRun::takeUpdate(std::int64_t frame_index) {
  if (!updates_.take()) return;
  tellApplied();
  tracking_.take(updates_.reading());
  if (sink_) sink_->tookUpdate(frame_index, updates_.reading().number);
}

// Before the update that follows from it is told.
void LiveRun::tellApplied() {
  Applied applied;
  while (applied_.pop(applied)) {
    if (sink_) sink_->appliedCorrection(applied.message, applied.number);
  }
}

// Mapping's thread.

void LiveRun::map() {
  while (true) {
    const bool tracking_ended = tracking_ended_.load(std::memory_order_acquire);
    const bool at_once = stopping_.load(std::memory_order_acquire) == Stopping::at_once;
    if (at_once && tracking_ended) break;
    const bool changed = mapOnce();
    if (changed) countMap();
    if (map_asked_.load(std::memory_order_acquire)) reportMap();
    if (changed) continue;
    if (tracking_ended && with_places_ == 0) break;
    std::this_thread::sleep_for(idle_time);
  }
  mapping_ended_.store(true, std::memory_order_release);
}

// One correction or one message; false where there is none.
bool LiveRun::mapOnce() {
  if (Correction* correction = corrections_.receive()) {
    applied_.push({mapping_.lastMessage() + 1, correction->number});
    publishUpdate(mapping_.apply(*correction));
    *correction = Correction();
    corrections_.release(correction);
    --with_places_;
  } else if (MappingMessage* message = messages_.receive()) {
    durations_.waiting_for_mapping.add(steadyNow_ns() - message->sent_ns);
    const Measured measured(durations_.mapping);
    publishUpdate(mapping_.handle(*message));
    message->frame.images.reset();
    message->edges.reset();
    messages_.release(message);
    tracking_.prepareImages();
    handSnapshot();
  } else {
    return false;
  }
  for (MappingReport& report : mapping_.takeReports()) {
    if (MappingReport* sent = reports_.claim()) {
      *sent = std::move(report);
      reports_.send(sent);
      sem_post(&result_ready_);
    }
  }
  return true;
}

void LiveRun::publishUpdate(std::optional<MapUpdate> update) {
  if (!update) return;
  updates_.writing() = std::move(*update);
  updates_.publish();
}

void LiveRun::countMap() {
  const Mapper& mapper = mapping_.mapper();
  map_changes_.fetch_add(1, std::memory_order_relaxed);
  keyframes_.store(mapper.initialised() ? mapper.map().keyframes.size() : 0, std::memory_order_relaxed);
  points_.store(mapper.initialised() ? mapper.map().points.size() : 0, std::memory_order_relaxed);
}

// Asked for again where there is no room now.
void LiveRun::reportMap() {
  MappingReport* sent = reports_.claim();
  if (!sent) return;
  map_asked_.store(false, std::memory_order_release);
  *sent = MappingReport();
  const Mapper& mapper = mapping_.mapper();
  sent->map = std::make_shared<const Map>(mapper.initialised() ? mapper.map() : Map());
  reports_.send(sent);
  sem_post(&result_ready_);
}

// Places works on one snapshot at a time; keyframes that come meanwhile are in the next one.
void LiveRun::handSnapshot() {
  if (!mapping_.hasNewKeyframe()) return;
  Snapshot* sent = snapshots_.claim();
  if (!sent) return;
  ++with_places_;
  *sent = *mapping_.snapshot();
  sent->sent_ns = steadyNow_ns();
  snapshots_.send(sent);
}

// Places' thread.

void LiveRun::lookAtPlaces() {
  while (true) {
    const bool mapping_ended = mapping_ended_.load(std::memory_order_acquire);
    Snapshot* snapshot = snapshots_.receive();
    if (!snapshot) {
      if (mapping_ended) break;
      std::this_thread::sleep_for(idle_time);
      continue;
    }
    durations_.waiting_for_places.add(steadyNow_ns() - snapshot->sent_ns);
    const std::int64_t start_ns = steadyNow_ns();
    Correction correction = places_.work(*snapshot);
    durations_.places.add(steadyNow_ns() - start_ns);
    *snapshot = Snapshot();
    if (Correction* sent = corrections_.claim()) {
      *sent = std::move(correction);
      corrections_.send(sent);
    }
    snapshots_.release(snapshot);
    if (mapping_ended) break;
  }
}

// Publishing's thread.

void LiveRun::publish() {
  std::int64_t next_tick_ns = steadyNow_ns();
  while (true) {
    waitFor(result_ready_, next_tick_ns);
    while (publishOnce()) {
    }
    if (steadyNow_ns() >= next_tick_ns) {
      if (observer_.tick) observer_.tick();
      next_tick_ns = steadyNow_ns() + tick_interval_ns;
    }
    if (mapping_ended_.load(std::memory_order_acquire) && tracking_ended_.load(std::memory_order_acquire) &&
        results_.waiting() == 0 && reports_.waiting() == 0) {
      break;
    }
  }
}

bool LiveRun::publishOnce() {
  if (Published* published = results_.receive()) {
    durations_.waiting_for_publishing.add(steadyNow_ns() - published->sent_ns);
    const Measured measured(durations_.publishing);
    if (observer_.frame) observer_.frame(published->result, published->problem);
    results_.release(published);
    return true;
  }
  if (MappingReport* report = reports_.receive()) {
    if (observer_.report) observer_.report(*report);
    report->map.reset();
    reports_.release(report);
    return true;
  }
  return false;
}

}  // namespace edgeslam
