// The live schedule (design, section 4): capture, tracking, mapping, places and publishing in threads of their own;
// each takes what the others made as it comes, and none waits for another. What was decided by the clock goes to the
// flight recorder, so that the run can be repeated.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "pipeline/live_channels.h"
#include "pipeline/live_counts.h"
#include "pipeline/live_mapping.h"
#include "pipeline/live_places.h"
#include "pipeline/live_publishing.h"
#include "pipeline/live_tracking.h"
#include "pipeline/thread_setup.h"

namespace edgeslam {

struct LiveOptions {
  bool lock_memory = false;
  ThreadSetup tracking{"tracking", 0, 0, false, {}};
  ThreadSetup publishing{"publishing", 0, 0, false, {}};
  ThreadSetup mapping{"mapping", 0, 0, false, {}};
  ThreadSetup places{"places", 0, 5, true, {}};
};

LiveOptions liveOptions(const ThreadOptions& options);

// Starts and stops the threads, and connects them; capture's thread is the caller's own.
class LiveRun {
 public:
  // `sink` may be null; it must outlive the run.
  LiveRun(const Camera& camera, const Settings& settings, const LiveOptions& options, LiveObserver observer,
          DecisionSink* sink);
  // Stops without settling.
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  // Before the start: continues a map made earlier.
  void goOnWith(Map map);
  // Before the start: frames that are asked for are shown there. `looks` must outlive the run.
  void showTo(FrameLooks& looks);
  void start();  // std::system_error where the system has no thread for it; only to be destroyed then

  // The capture thread's: fill the slot, then hand it over. Never waits.
  FrameSlot& nextSlot() { return channels_.frames.writing(); }
  void handOver();

  // What an inertial unit measured, in order, from one thread, which may be another than capture's. Never waits: what
  // is not usable (isUsable()), or comes while tracking is seconds behind, is left out.
  void add(const InertialSample& sample);
  // Where the wheels say that the robot was, likewise.
  void add(const OdometryPose& pose);

  // From any thread: the map as it is comes in a report, as soon as mapping is between two messages; without keyframes
  // where there is none yet.
  void askForMap() { mapping_.askForMap(); }

  // No frames are handed over any more. `settle`: mapping and places finish what they were given; otherwise they leave
  // it where it is, within 1 s. The map is final then.
  void stop(bool settle);

  LiveCounts counts() const;
  // How long the work of the threads took, and how long it waited for them, so far.
  std::vector<DurationSummary> durations() const;
  // What could not be set up of the memory and of the threads. After start().
  const std::vector<RefusedSetup>& problems() const { return problems_; }
  // After stop().
  const Mapper& mapper() const;

 private:
  template <typename Part>
  void startThread(std::thread& thread, const ThreadSetup& setup, Part& part);

  LiveOptions options_;
  LiveChannels channels_;
  LiveTracking tracking_;
  LiveMapping mapping_;
  LivePlaces places_;
  LivePublishing publishing_;
  std::atomic<std::int64_t> captured_{0};
  std::vector<RefusedSetup> problems_;
  std::thread tracking_thread_, mapping_thread_, places_thread_, publishing_thread_;
};

}  // namespace edgeslam
