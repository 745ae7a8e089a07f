#include "pipeline/live_publishing.h"

#include <utility>

namespace edgeslam {
namespace {

constexpr std::int64_t tick_interval_ns = 100'000'000;

}  // namespace

LivePublishing::LivePublishing(LiveObserver observer, LiveChannels& channels)
    : observer_(std::move(observer)), channels_(channels) {}

void LivePublishing::run() {
  std::int64_t next_tick_ns = steadyNow_ns();
  while (true) {
    channels_.result_ready.waitUntil(next_tick_ns);
    while (publishOnce()) {
    }
    if (steadyNow_ns() >= next_tick_ns) {
      if (observer_.tick) observer_.tick();
      next_tick_ns = steadyNow_ns() + tick_interval_ns;
    }
    if (isAtEnd()) break;
  }
}

// One result or one report; false where there is none.
bool LivePublishing::publishOnce() {
  if (PublishedFrame* published = channels_.results.receive()) {
    waiting_durations_.add(steadyNow_ns() - published->sent_ns);
    const Measured measured(durations_);
    if (observer_.frame) observer_.frame(published->result, published->problem);
    channels_.results.release(published);
    return true;
  }
  if (MappingReport* report = channels_.reports.receive()) {
    if (observer_.report) observer_.report(*report);
    report->map.reset();
    channels_.reports.release(report);
    return true;
  }
  return false;
}

bool LivePublishing::isAtEnd() const {
  return channels_.mapping_ended.load(std::memory_order_acquire) &&
         channels_.tracking_ended.load(std::memory_order_acquire) && channels_.results.waiting() == 0 &&
         channels_.reports.waiting() == 0;
}

void LivePublishing::addDurations(std::vector<DurationSummary>& durations) const {
  durations.push_back(waiting_durations_.summary("waiting for publishing"));
  durations.push_back(durations_.summary("publishing"));
}

}  // namespace edgeslam
