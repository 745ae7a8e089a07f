#include "pipeline/live_run.h"

#include <cassert>
#include <future>
#include <optional>
#include <utility>

#include "inertia/inertial_history.h"

namespace edgeslam {
namespace {

ThreadSetup threadSetup(const std::string& name, int priority, int nice, bool batch, int processor) {
  return {name, priority, nice, batch, processor >= 0 ? std::vector<int>{processor} : std::vector<int>{}};
}

}  // namespace

LiveOptions liveOptions(const ThreadOptions& options) {
  LiveOptions live;
  live.lock_memory = options.lock_memory;
  live.tracking = threadSetup("tracking", options.tracking_priority, 0, false, options.tracking_processor);
  live.publishing = threadSetup("publishing", options.publishing_priority, 0, false, -1);
  live.mapping = threadSetup("mapping", 0, options.mapping_nice, false, options.mapping_processor);
  live.places = threadSetup("places", 0, options.places_nice, true, options.places_processor);
  return live;
}

LiveRun::LiveRun(const Camera& camera, const Settings& settings, const LiveOptions& options, LiveObserver observer,
                 DecisionSink* sink)
    : options_(options),
      channels_(camera.width, camera.height, static_cast<std::size_t>(settings.points.count),
                settings.tracking.inertia.has_value()),
      tracking_(camera, settings, channels_, sink),
      mapping_(camera, settings, channels_, tracking_),
      places_(camera, settings, channels_),
      publishing_(std::move(observer), channels_) {}

LiveRun::~LiveRun() { stop(/*settle=*/false); }

void LiveRun::goOnWith(Map map) {
  assert(!tracking_thread_.joinable());
  const PointId first_free_point = firstFreePoint(map);
  mapping_.goOnWith(std::move(map));
  tracking_.goOnWith(mapping_.mapper().view(), first_free_point);
}

void LiveRun::showTo(FrameLooks& looks) {
  assert(!tracking_thread_.joinable());
  tracking_.showTo(looks);
}

void LiveRun::start() {
  assert(!publishing_thread_.joinable());
  if (options_.lock_memory) {
    if (std::optional<RefusedSetup> problem = lockMemory()) problems_.push_back(std::move(*problem));
  }
  startThread(publishing_thread_, options_.publishing, publishing_);
  startThread(places_thread_, options_.places, places_);
  startThread(mapping_thread_, options_.mapping, mapping_);
  startThread(tracking_thread_, options_.tracking, tracking_);
}

template <typename Part>
void LiveRun::startThread(std::thread& thread, const ThreadSetup& setup, Part& part) {
  std::promise<std::optional<RefusedSetup>> ready;
  std::future<std::optional<RefusedSetup>> problem = ready.get_future();
  thread = std::thread([&part, setup, ready = std::move(ready)]() mutable {
    ready.set_value(setUpThread(setup));
    part.run();
  });
  if (std::optional<RefusedSetup> told = problem.get()) problems_.push_back(std::move(*told));
}

void LiveRun::handOver() {
  channels_.frames.writing().handed_over_ns = steadyNow_ns();
  channels_.frames.publish();
  captured_.fetch_add(1, std::memory_order_relaxed);
  channels_.frame_ready.post();
}

void LiveRun::add(const InertialSample& sample) {
  if (isUsable(sample)) channels_.inertia.push(sample);
}

void LiveRun::add(const OdometryPose& pose) {
  if (isUsable(pose)) channels_.wheels.push(pose);
}

void LiveRun::stop(bool settle) {
  if (!publishing_thread_.joinable()) return;
  // No thread could be started for them.
  if (!tracking_thread_.joinable()) channels_.tracking_ended.store(true, std::memory_order_release);
  if (!mapping_thread_.joinable()) channels_.mapping_ended.store(true, std::memory_order_release);
  channels_.stopping.store(settle ? Stopping::settle : Stopping::at_once, std::memory_order_release);
  places_.interrupt(!settle);
  channels_.frame_ready.post();
  for (std::thread* thread : {&tracking_thread_, &mapping_thread_, &places_thread_}) {
    if (thread->joinable()) thread->join();
  }
  tracking_.tellApplied();
  channels_.result_ready.post();
  publishing_thread_.join();
}

const Mapper& LiveRun::mapper() const {
  assert(!mapping_thread_.joinable());
  return mapping_.mapper();
}

LiveCounts LiveRun::counts() const {
  LiveCounts counts;
  counts.captured = captured_.load(std::memory_order_relaxed);
  tracking_.count(counts);
  counts.messages_waiting = channels_.messages.waiting();
  counts.results_waiting = channels_.results.waiting();
  mapping_.count(counts);
  return counts;
}

std::vector<DurationSummary> LiveRun::durations() const {
  std::vector<DurationSummary> durations;
  tracking_.addDurations(durations);
  mapping_.addDurations(durations);
  places_.addDurations(durations);
  publishing_.addDurations(durations);
  return durations;
}

}  // namespace edgeslam
