#include "pipeline/live_places.h"

#include <chrono>
#include <thread>
#include <utility>

namespace edgeslam {
namespace {}  // namespace

void LivePlaces::run() {
  while (true) {
    const bool mapping_ended = channels_.mapping_ended.load(std::memory_order_acquire);
    Snapshot* snapshot = channels_.snapshots.receive();
    if (snapshot) work(snapshot);
    if (mapping_ended) break;
    if (!snapshot) std::this_thread::sleep_for(idle_time);
  }
}

void LivePlaces::work(Snapshot* snapshot) {
  waiting_durations_.add(steadyNow_ns() - snapshot->sent_ns);
  const std::int64_t start_ns = steadyNow_ns();
  Correction correction = worker_.work(*snapshot);
  durations_.add(steadyNow_ns() - start_ns);
  *snapshot = Snapshot();
  if (Correction* sent = channels_.corrections.claim()) {
    *sent = std::move(correction);
    channels_.corrections.send(sent);
  }
  channels_.snapshots.release(snapshot);
}

void LivePlaces::addDurations(std::vector<DurationSummary>& durations) const {
  durations.push_back(waiting_durations_.summary("waiting for places"));
  durations.push_back(durations_.summary("places"));
}

}  // namespace edgeslam
