// What tracking's thread of a live run does: takes the newest frame, tracks it, and hands on what came of it. Once
// running it never waits but for a frame, and neither locks nor allocates.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "pipeline/decision_sink.h"
#include "pipeline/duration_statistics.h"
#include "pipeline/frame_look.h"
#include "pipeline/live_channels.h"
#include "pipeline/live_counts.h"
#include "pipeline/tracking_worker.h"

namespace edgeslam {

class LiveTracking {
 public:
  // `channels` must outlive it, and so must `sink`, which may be null.
  LiveTracking(const Camera& camera, const Settings& settings, LiveChannels& channels, DecisionSink* sink);

  // Before the first frame.
  void goOnWith(const MapView& view, PointId first_free_point) { worker_.goOnWith(view, first_free_point); }
  void showTo(FrameLooks& looks) { looks_ = &looks; }

  // The thread's work, until the run is stopped. The frame that came last is tracked yet.
  void run();
  // After the end of tracking and of mapping: what mapping applied since the last update was taken.
  void tellApplied();

  // For mapping's thread, after each message: images for the frames to come.
  void prepareImages() { worker_.prepareImages(); }

  // From any thread.
  void count(LiveCounts& counts) const;
  void addDurations(std::vector<DurationSummary>& durations) const;

 private:
  void track(FrameSlot& slot);
  void tellPassedOver();
  void takeUpdate(std::int64_t frame_index);
  template <typename Waiting>
  void takeMeasured(Waiting& waiting, std::int64_t frame_index);
  bool isMappingBusy() const;
  void publish(const FrameSlot& slot, const FrameResult& result);
  void sendMessages();

  LiveChannels& channels_;
  DecisionSink* sink_;
  FrameLooks* looks_ = nullptr;
  TrackingWorker worker_;
  FrameMessages new_messages_;
  DurationStatistics waiting_durations_, durations_;
  std::atomic<std::int64_t> processed_{0}, passed_over_{0}, mapping_behind_{0}, not_published_{0};
};

}  // namespace edgeslam
