// The live schedule (design, section 4): capture, tracking, mapping, places and publishing in threads of their own;
// each takes what the others made as it comes, and none waits for another. What was decided by the clock goes to the
// flight recorder, so that the run can be repeated.
#pragma once

#include <semaphore.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/channel.h"
#include "pipeline/decision_sink.h"
#include "pipeline/duration_statistics.h"
#include "pipeline/frame_look.h"
#include "pipeline/frame_slots.h"
#include "pipeline/mapping_worker.h"
#include "pipeline/places_worker.h"
#include "pipeline/thread_setup.h"
#include "pipeline/tracking_worker.h"
#include "pipeline/triple_buffer.h"

namespace edgeslam {

struct LiveOptions {
  bool lock_memory = false;
  ThreadSetup tracking{"tracking", 0, 0, false, {}};
  ThreadSetup publishing{"publishing", 0, 0, false, {}};
  ThreadSetup mapping{"mapping", 0, 0, false, {}};
  ThreadSetup places{"places", 0, 5, true, {}};
};

LiveOptions liveOptions(const ThreadOptions& options);

// Called by the publishing thread, in the order of the frames.
struct LiveObserver {
  std::function<void(const FrameResult&, const std::string& problem)> frame;  // `problem`: why it could not be read
  std::function<void(const MappingReport&)> report;
  std::function<void()> tick;  // each 100 ms or so, frames or not
};

// Counters of a run, as of now.
struct LiveCounts {
  std::int64_t captured = 0;
  std::int64_t processed = 0;
  std::int64_t passed_over = 0;     // a newer frame was there when tracking came to take it
  std::int64_t mapping_behind = 0;  // frames that told mapping nothing, its queue being nearly full
  std::int64_t not_published = 0;   // results for which the publishing queue was full
  std::size_t messages_waiting = 0;
  std::size_t results_waiting = 0;
  std::int64_t map_changes = 0;  // messages and corrections that mapping took in
  std::size_t keyframes = 0;     // of the map; 0 while there is none
  std::size_t points = 0;
};

class LiveRun {
 public:
  // `sink` may be null; it must outlive the run.
  LiveRun(const Camera& camera, const Settings& settings, const LiveOptions& options, LiveObserver observer,
          DecisionSink* sink);
  // Stops without settling.
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  // Before the start: goes on with a map made earlier.
  void goOnWith(Map map);
  // Before the start: frames that are asked for are shown there. `looks` must outlive the run.
  void showTo(FrameLooks& looks) { looks_ = &looks; }
  void start();  // std::system_error where the system has no thread for it; only to be destroyed then

  // The capture thread's: fill the slot, then hand it over. Never waits.
  FrameSlot& nextSlot() { return frames_.writing(); }
  void handOver();

  // From any thread: the map as it is comes in a report, as soon as mapping is between two messages; without keyframes
  // where there is none yet.
  void askForMap() { map_asked_.store(true, std::memory_order_release); }

  // No frames are handed over any more. `settle`: mapping and places finish what they were given; otherwise they leave
  // it where it is, within 1 s. The map is final then.
  void stop(bool settle);

  LiveCounts counts() const;
  // How long the work of the threads took, and how long it waited for them, so far.
  std::vector<DurationSummary> durations() const;
  // What could not be set up of the threads, a line each. After start().
  std::vector<std::string> problems() const { return problems_; }
  // After stop().
  const Mapper& mapper() const { return mapping_.mapper(); }

 private:
  struct Published {
    FrameResult result;
    std::string problem;
    std::int64_t sent_ns = 0;  // steady clock
  };
  struct Durations {
    DurationStatistics waiting_for_tracking, tracking;      // added by tracking
    DurationStatistics waiting_for_mapping, mapping;        // by mapping
    DurationStatistics waiting_for_places, places;          // by places
    DurationStatistics waiting_for_publishing, publishing;  // by publishing
  };
  struct Applied {
    std::int64_t message = 0, number = 0;
  };
  enum class Stopping { no, settle, at_once };

  void track();
  void trackFrame(FrameSlot& slot);
  bool isMappingBusy() const;
  void takeUpdate(std::int64_t frame_index);
  void tellApplied();
  void map();
  bool mapOnce();
  void publishUpdate(std::optional<MapUpdate> update);
  void countMap();
  void reportMap();
  void handSnapshot();
  void lookAtPlaces();
  void publish();
  bool publishOnce();

  Settings settings_;
  LiveOptions options_;
  LiveObserver observer_;
  DecisionSink* sink_;
  FrameLooks* looks_ = nullptr;
  TrackingWorker tracking_;
  MappingWorker mapping_;
  PlacesWorker places_;

  FrameSlots frames_;                                   // capture to tracking
  Channel<MappingMessage> messages_{64};                // tracking to mapping
  TripleBuffer<MapUpdate> updates_;                     // mapping to tracking
  boost::lockfree::spsc_queue<Applied> applied_{1024};  // mapping to tracking, for the sink
  Channel<Snapshot> snapshots_{1};                      // mapping to places
  Channel<Correction> corrections_{2};                  // places to mapping
  Channel<Published> results_{256};                     // tracking to publishing
  Channel<MappingReport> reports_{256};                 // mapping to publishing
  sem_t frame_ready_, result_ready_;

  FrameMessages new_messages_;  // tracking's alone
  Durations durations_;
  std::atomic<Stopping> stopping_{Stopping::no};
  std::atomic<bool> tracking_ended_{false}, mapping_ended_{false}, map_asked_{false};
  std::int64_t with_places_ = 0;  // snapshots whose corrections mapping has not received yet; mapping's alone
  std::atomic<std::int64_t> captured_{0}, processed_{0}, passed_over_{0}, mapping_behind_{0}, not_published_{0};
  std::atomic<std::int64_t> map_changes_{0};
  std::atomic<std::size_t> keyframes_{0}, points_{0};
  std::vector<std::string> problems_;
  std::thread tracking_thread_, mapping_thread_, places_thread_, publishing_thread_;
};

}  // namespace edgeslam
