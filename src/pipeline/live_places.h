// What places' thread of a live run does: works on one snapshot of the map after the other, and hands each one's
// correction to mapping.
#pragma once

#include <vector>

#include "pipeline/duration_statistics.h"
#include "pipeline/live_channels.h"
#include "pipeline/places_worker.h"

namespace edgeslam {

class LivePlaces {
 public:
  // `channels` must outlive it.
  LivePlaces(const Camera& camera, const Settings& settings, LiveChannels& channels)
      : channels_(channels), worker_(camera, settings) {}

  // The thread's work, until mapping has ended.
  void run();

  // From any thread: see PlacesWorker.
  void interrupt(bool interrupted) { worker_.interrupt(interrupted); }
  void addDurations(std::vector<DurationSummary>& durations) const;

 private:
  void work(Snapshot* snapshot);

  LiveChannels& channels_;
  PlacesWorker worker_;
  DurationStatistics waiting_durations_, durations_;
};

}  // namespace edgeslam
