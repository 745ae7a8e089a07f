#include "pipeline/live_run.h"

#include <future>
#include <utility>

namespace edgeslam {
namespace {

constexpr std::size_t longest_reason = 256;

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
    : settings_(settings),
      options_(options),
      observer_(std::move(observer)),
      sink_(sink),
      tracking_(camera, settings),
      mapping_(camera, settings),
      places_(camera, settings),
      frames_(camera.width, camera.height) {
  sem_init(&frame_ready_, 0, 0);
  sem_init(&result_ready_, 0, 0);
  messages_.forEachSlot([&](MappingMessage& message) {
    message.frame.observations.reserve(static_cast<std::size_t>(settings.points.count));
  });
  for (MappingMessage& message : new_messages_.all()) {
    message.frame.observations.reserve(static_cast<std::size_t>(settings.points.count));
  }
  results_.forEachSlot([](Published& published) {
    published.result.reason.reserve(longest_reason);
    published.problem.reserve(longest_reason);
  });
}

LiveRun::~LiveRun() {
  stop(/*settle=*/false);
  sem_destroy(&frame_ready_);
  sem_destroy(&result_ready_);
}

void LiveRun::goOnWith(Map map) {
  const PointId first_free_point = firstFreePoint(map);
  mapping_.goOnWith(std::move(map));
  tracking_.goOnWith(mapping_.mapper().view(), first_free_point);
  countMap();
}

void LiveRun::start() {
  if (options_.lock_memory) {
    std::string problem = lockMemory();
    if (!problem.empty()) problems_.push_back(std::move(problem));
  }
  const auto startThread = [&](std::thread& thread, const ThreadSetup& setup, void (LiveRun::*work)()) {
    std::promise<std::string> ready;
    std::future<std::string> problem = ready.get_future();
    thread = std::thread([this, setup, work, ready = std::move(ready)]() mutable {
      ready.set_value(setUpThread(setup));
      (this->*work)();
    });
    std::string told = problem.get();
    if (!told.empty()) problems_.push_back(std::move(told));
  };
  startThread(publishing_thread_, options_.publishing, &LiveRun::publish);
  startThread(places_thread_, options_.places, &LiveRun::lookAtPlaces);
  startThread(mapping_thread_, options_.mapping, &LiveRun::map);
  startThread(tracking_thread_, options_.tracking, &LiveRun::track);
}

void LiveRun::handOver() {
  frames_.writing().handed_over_ns = steadyNow_ns();
  frames_.publish();
  captured_.fetch_add(1, std::memory_order_relaxed);
  sem_post(&frame_ready_);
}

void LiveRun::stop(bool settle) {
  if (!publishing_thread_.joinable()) return;
  // No thread could be started for them.
  if (!tracking_thread_.joinable()) tracking_ended_.store(true, std::memory_order_release);
  if (!mapping_thread_.joinable()) mapping_ended_.store(true, std::memory_order_release);
  stopping_.store(settle ? Stopping::settle : Stopping::at_once, std::memory_order_release);
  places_.interrupt(!settle);
  sem_post(&frame_ready_);
  for (std::thread* thread : {&tracking_thread_, &mapping_thread_, &places_thread_}) {
    if (thread->joinable()) thread->join();
  }
  tellApplied();
  sem_post(&result_ready_);
  publishing_thread_.join();
}

LiveCounts LiveRun::counts() const {
  LiveCounts counts;
  counts.captured = captured_.load(std::memory_order_relaxed);
  counts.processed = processed_.load(std::memory_order_relaxed);
  counts.passed_over = passed_over_.load(std::memory_order_relaxed);
  counts.mapping_behind = mapping_behind_.load(std::memory_order_relaxed);
  counts.not_published = not_published_.load(std::memory_order_relaxed);
  counts.messages_waiting = messages_.waiting();
  counts.results_waiting = results_.waiting();
  counts.map_changes = map_changes_.load(std::memory_order_relaxed);
  counts.keyframes = keyframes_.load(std::memory_order_relaxed);
  counts.points = points_.load(std::memory_order_relaxed);
  return counts;
}

std::vector<DurationSummary> LiveRun::durations() const {
  return {
      durations_.waiting_for_tracking.summary("waiting for tracking"),     durations_.tracking.summary("tracking"),
      durations_.waiting_for_mapping.summary("waiting for mapping"),       durations_.mapping.summary("mapping"),
      durations_.waiting_for_places.summary("waiting for places"),         durations_.places.summary("places"),
      durations_.waiting_for_publishing.summary("waiting for publishing"), durations_.publishing.summary("publishing")};
}

}  // namespace edgeslam
