// What mapping's thread of a live run does: takes tracking's messages and places' corrections as they come, and hands
// on updates, snapshots and reports.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/duration_statistics.h"
#include "pipeline/live_channels.h"
#include "pipeline/live_counts.h"
#include "pipeline/live_tracking.h"
#include "pipeline/mapping_worker.h"

namespace edgeslam {

class LiveMapping {
 public:
  // `channels` and `tracking`, whose images it prepares, must outlive it.
  LiveMapping(const Camera& camera, const Settings& settings, LiveChannels& channels, LiveTracking& tracking)
      : channels_(channels), tracking_(tracking), worker_(camera, settings) {}

  // Before the first message.
  void goOnWith(Map map);

  // The thread's work, until tracking has ended and, where the run settles, all is done that waits.
  void run();

  // From any thread: the map as it is comes in a report.
  void askForMap() { map_asked_.store(true, std::memory_order_release); }
  void count(LiveCounts& counts) const;
  void addDurations(std::vector<DurationSummary>& durations) const;

  // While the thread does not run.
  const Mapper& mapper() const { return worker_.mapper(); }

 private:
  bool mapOnce();
  void apply(Correction* correction);
  void handle(MappingMessage* message);
  void publishUpdate(std::optional<MapUpdate> update);
  void handSnapshot();
  void sendReports();
  void countMap();
  void reportMap();

  LiveChannels& channels_;
  LiveTracking& tracking_;
  MappingWorker worker_;
  std::int64_t with_places_ = 0;  // snapshots whose corrections have not come yet
  DurationStatistics waiting_durations_, durations_;
  std::atomic<bool> map_asked_{false};
  std::atomic<std::int64_t> map_changes_{0};
  std::atomic<std::size_t> keyframes_{0}, points_{0};
};

}  // namespace edgeslam
