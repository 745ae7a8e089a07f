#include "pipeline/live_mapping.h"

#include <chrono>
#include <memory>
#include <thread>
#include <utility>

namespace edgeslam {
namespace {}  // namespace

void LiveMapping::goOnWith(Map map) {
  worker_.goOnWith(std::move(map));
  countMap();
}

void LiveMapping::run() {
  while (true) {
    const bool tracking_ended = channels_.tracking_ended.load(std::memory_order_acquire);
    const bool at_once = channels_.stopping.load(std::memory_order_acquire) == Stopping::at_once;
    if (at_once && tracking_ended) break;
    const bool changed = mapOnce();
    if (changed && !worker_.mapIsFrozen()) countMap();
    if (map_asked_.load(std::memory_order_acquire)) reportMap();
    if (changed) continue;
    if (tracking_ended && with_places_ == 0) break;
    std::this_thread::sleep_for(idle_time);
  }
  channels_.mapping_ended.store(true, std::memory_order_release);
}

// One correction or one message; false where there is none.
bool LiveMapping::mapOnce() {
  if (Correction* correction = channels_.corrections.receive()) {
    apply(correction);
  } else if (MappingMessage* message = channels_.messages.receive()) {
    handle(message);
  } else {
    return false;
  }
  sendReports();
  return true;
}

void LiveMapping::apply(Correction* correction) {
  channels_.applied.push({worker_.lastMessage() + 1, correction->number});
  publishUpdate(worker_.apply(*correction));
  *correction = Correction();
  channels_.corrections.release(correction);
  --with_places_;
}

void LiveMapping::handle(MappingMessage* message) {
  waiting_durations_.add(steadyNow_ns() - message->sent_ns);
  const Measured measured(durations_);
  publishUpdate(worker_.handle(*message));
  message->frame.images.reset();
  message->edges.reset();
  channels_.messages.release(message);
  tracking_.prepareImages();
  handSnapshot();
}

void LiveMapping::publishUpdate(std::optional<MapUpdate> update) {
  if (!update) return;
  channels_.updates.writing() = std::move(*update);
  channels_.updates.publish();
}

// Places works on one snapshot at a time; keyframes that come meanwhile are in the next one.
void LiveMapping::handSnapshot() {
  if (!worker_.hasNewKeyframe()) return;
  Snapshot* sent = channels_.snapshots.claim();
  if (!sent) return;
  ++with_places_;
  *sent = *worker_.snapshot();
  sent->sent_ns = steadyNow_ns();
  channels_.snapshots.send(sent);
}

void LiveMapping::sendReports() {
  for (MappingReport& report : worker_.takeReports()) {
    if (MappingReport* sent = channels_.reports.claim()) {
      *sent = std::move(report);
      channels_.reports.send(sent);
      channels_.result_ready.post();
    }
  }
}

void LiveMapping::countMap() {
  const Mapper& mapper = worker_.mapper();
  map_changes_.fetch_add(1, std::memory_order_relaxed);
  keyframes_.store(mapper.map().keyframes.size(), std::memory_order_relaxed);
  points_.store(mapper.map().points.size(), std::memory_order_relaxed);
}

// Asked for again where there is no room now.
void LiveMapping::reportMap() {
  MappingReport* sent = channels_.reports.claim();
  if (!sent) return;
  map_asked_.store(false, std::memory_order_release);
  *sent = MappingReport();
  const Mapper& mapper = worker_.mapper();
  sent->map = std::make_shared<const Map>(mapper.map());
  channels_.reports.send(sent);
  channels_.result_ready.post();
}

void LiveMapping::count(LiveCounts& counts) const {
  counts.map_changes = map_changes_.load(std::memory_order_relaxed);
  counts.keyframes = keyframes_.load(std::memory_order_relaxed);
  counts.points = points_.load(std::memory_order_relaxed);
}

void LiveMapping::addDurations(std::vector<DurationSummary>& durations) const {
  durations.push_back(waiting_durations_.summary("waiting for mapping"));
  durations.push_back(durations_.summary("mapping"));
}

}  // namespace edgeslam
