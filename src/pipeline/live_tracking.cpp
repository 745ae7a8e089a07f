#include "pipeline/live_tracking.h"

#include <utility>

namespace edgeslam {
namespace {

constexpr std::size_t most_waiting_for_a_map = 3;
constexpr std::size_t least_room = 8;  // in mapping's queue, for a frame to tell it anything

}  // namespace

LiveTracking::LiveTracking(const Camera& camera, const Settings& settings, LiveChannels& channels, DecisionSink* sink)
    : channels_(channels), sink_(sink), worker_(camera, settings) {
  for (MappingMessage& message : new_messages_.all()) {
    reserve(static_cast<std::size_t>(settings.points.count), settings.tracking.inertia.has_value(), message.frame);
  }
}

void LiveTracking::run() {
  while (true) {
    channels_.frame_ready.wait();
    const bool stopping = channels_.stopping.load(std::memory_order_acquire) != Stopping::no;
    if (channels_.frames.take()) track(channels_.frames.reading());
    if (stopping) break;
  }
  channels_.tracking_ended.store(true, std::memory_order_release);
}

void LiveTracking::track(FrameSlot& slot) {
  waiting_durations_.add(steadyNow_ns() - slot.handed_over_ns);
  const Measured measured(durations_);
  tellPassedOver();
  takeUpdate(slot.index);
  takeMeasured(channels_.inertia, slot.index);
  takeMeasured(channels_.wheels, slot.index);
  const bool mapping_busy = isMappingBusy();
  if (mapping_busy) mapping_behind_.fetch_add(1, std::memory_order_relaxed);
  if (mapping_busy && sink_) sink_->mappingBusy(slot.index);
  new_messages_.clear();
  const FrameResult& result = slot.problem.empty()
                                  ? worker_.process(slot.index, slot.time_ns, slot.grey, mapping_busy, new_messages_)
                                  : worker_.skip(slot.index, slot.time_ns, slot.problem);
  publish(slot, result);
  sendMessages();
  if (sink_ && slot.problem.empty()) sink_->processed(worker_.images(), slot.jpeg);
  if (sink_ && !slot.problem.empty()) sink_->unreadable(slot.index, slot.time_ns, slot.problem);
  if (looks_ && slot.problem.empty()) looks_->show(result, worker_.tracker());
  processed_.fetch_add(1, std::memory_order_relaxed);
}

void LiveTracking::tellPassedOver() {
  PassedOverFrame passed_over;
  while (channels_.frames.nextPassedOver(passed_over)) {
    passed_over_.fetch_add(1, std::memory_order_relaxed);
    if (sink_) sink_->passedOver(passed_over.index, passed_over.time_ns);
  }
}

void LiveTracking::takeUpdate(std::int64_t frame_index) {
  if (!channels_.updates.take()) return;
  tellApplied();
  worker_.take(channels_.updates.reading());
  if (sink_) sink_->tookUpdate(frame_index, channels_.updates.reading().number);
}

// All that has come: what comes later than its frame, the next one has.
template <typename Waiting>
void LiveTracking::takeMeasured(Waiting& waiting, std::int64_t frame_index) {
  typename Waiting::value_type sample;
  while (waiting.pop(sample)) {
    worker_.add(sample);
    if (sink_) sink_->measured(frame_index, sample);
  }
}

// Before the update that follows from it is told.
void LiveTracking::tellApplied() {
  AppliedCorrection applied;
  while (channels_.applied.pop(applied)) {
    if (sink_) sink_->appliedCorrection(applied.message, applied.number);
  }
}

// Before the map stands, what mapping makes of a frame is of use for as long as the first frame's points are in view.
bool LiveTracking::isMappingBusy() const {
  if (!worker_.hasMap()) return channels_.messages.waiting() > most_waiting_for_a_map;
  return channels_.messages.room() < least_room;
}

void LiveTracking::publish(const FrameSlot& slot, const FrameResult& result) {
  if (PublishedFrame* published = channels_.results.claim()) {
    published->result = result;
    published->result.latency_ms = static_cast<double>(steadyNow_ns() - slot.handed_over_ns) * 1e-6;
    published->problem = slot.problem;
    published->sent_ns = steadyNow_ns();
    channels_.results.send(published);
    channels_.result_ready.post();
  } else {
    not_published_.fetch_add(1, std::memory_order_relaxed);
  }
}

// There is room: a mapping that is busy is told nothing.
void LiveTracking::sendMessages() {
  for (MappingMessage& message : new_messages_) {
    MappingMessage* sent = channels_.messages.claim();
    std::swap(*sent, message);
    sent->sent_ns = steadyNow_ns();
    channels_.messages.send(sent);
  }
}

void LiveTracking::count(LiveCounts& counts) const {
  counts.processed = processed_.load(std::memory_order_relaxed);
  counts.passed_over = passed_over_.load(std::memory_order_relaxed);
  counts.mapping_behind = mapping_behind_.load(std::memory_order_relaxed);
  counts.not_published = not_published_.load(std::memory_order_relaxed);
}

void LiveTracking::addDurations(std::vector<DurationSummary>& durations) const {
  durations.push_back(waiting_durations_.summary("waiting for tracking"));
  durations.push_back(durations_.summary("tracking"));
}

}  // namespace edgeslam
