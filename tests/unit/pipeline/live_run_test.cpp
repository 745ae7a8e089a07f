// The live schedule: what a run under load decided can be repeated to the last bit, nothing is lost that was to be
// given out, and a run ends when it is told to.
#include "pipeline/live_run.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "pipeline/lockstep_run.h"
#include "pipeline/run_record.h"
#include "simulator/simulator.h"

namespace edgeslam {
namespace {

using std::chrono::milliseconds;

constexpr int live_frames = 70;

struct MadeFrames {
  SimulatedSequence sequence;
  std::vector<cv::Mat> images;
};

// With a covered lens, so that a loss and what follows are among it.
const MadeFrames& made() {
  static const MadeFrames frames = [] {
    SimulationOptions options;
    options.scene = SceneKind::panels_textured;
    options.frames = live_frames;
    options.width = 320;
    options.height = 240;
    options.covered = {{45, 6}};
    MadeFrames made{makeSequence(options), {}};
    for (int i = 0; i < live_frames; ++i) made.images.push_back(made.sequence.frame(i).grey);
    return made;
  }();
  return frames;
}

// Keeps all that was decided, as the flight recorder does.
class KeptDecisions : public DecisionSink {
 public:
  void tookUpdate(std::int64_t frame_index, std::int64_t number) noexcept override {
    decisions.updates[frame_index] = number;
  }
  void measured(std::int64_t frame_index, const InertialSample& sample) noexcept override {
    decisions.inertia[frame_index].push_back(sample);
  }
  void measured(std::int64_t frame_index, const OdometryPose& pose) noexcept override {
    decisions.wheels[frame_index].push_back(pose);
  }
  void mappingBusy(std::int64_t frame_index) noexcept override { decisions.mapping_busy.insert(frame_index); }
  void appliedCorrection(std::int64_t message, std::int64_t number) noexcept override {
    decisions.corrections[message].push_back(number);
    decisions.snapshots.insert(number);
  }
  void passedOver(std::int64_t index, std::int64_t /*time_ns*/) noexcept override { passed_over.push_back(index); }
  void processed(const std::shared_ptr<const FrameImages>& processed, const CameraJpeg& /*jpeg*/) noexcept override {
    frames.push_back(processed->frame_index);
    images.push_back(processed->pyramid.levels[0].clone());
  }
  void unreadable(std::int64_t index, std::int64_t /*time_ns*/, const std::string& /*problem*/) noexcept override {
    frames.push_back(index);
    images.emplace_back();
  }

  RunDecisions decisions;
  std::vector<std::int64_t> frames, passed_over;
  std::vector<cv::Mat> images;
};

struct LiveResult {
  RunResult run;
  LiveCounts counts;
};

// Until tracking and mapping have done what they were given.
void waitUntilIdle(const LiveRun& live) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (std::chrono::steady_clock::now() < end) {
    const LiveCounts counts = live.counts();
    if (counts.processed + counts.passed_over == counts.captured && counts.messages_waiting == 0) return;
    std::this_thread::sleep_for(milliseconds(1));
  }
}

LiveObserver recordingTo(RunRecord& record) {
  LiveObserver observer;
  observer.frame = [&](const FrameResult& frame, const std::string& problem) { record.add(frame, !problem.empty()); };
  observer.report = [&](const MappingReport& report) { record.add(report); };
  return observer;
}

void handFrame(LiveRun& live, int i, const std::string& problem = "") {
  FrameSlot& slot = live.nextSlot();
  slot.index = i;
  slot.time_ns = made().sequence.time(i);
  slot.problem = problem;
  made().images[static_cast<std::size_t>(i % live_frames)].copyTo(slot.grey);
  live.handOver();
}

// `interval` 0: each frame waits until the one before is done with.
LiveResult runLive(DecisionSink* sink, milliseconds interval, int frames = live_frames, bool settle = true,
                   int unreadable = -1) {
  RunRecord record(made().sequence.camera);
  LiveRun live(made().sequence.camera, Settings(), LiveOptions(), recordingTo(record), sink);
  live.start();
  for (int i = 0; i < frames; ++i) {
    handFrame(live, i, i == unreadable ? "torn" : "");
    if (interval.count() == 0) waitUntilIdle(live);
    std::this_thread::sleep_for(interval);
  }
  live.stop(settle);
  return {record.finish(live.mapper()), live.counts()};
}

RunResult repeat(const KeptDecisions& kept) {
  LockstepRun run(made().sequence.camera, Settings(), 0, 0);
  run.repeat(kept.decisions);
  for (std::size_t k = 0; k < kept.frames.size(); ++k) {
    const std::int64_t index = kept.frames[k], time = made().sequence.time(static_cast<int>(index));
    if (kept.images[k].empty()) {
      run.skip(index, time, "torn");
    } else {
      run.process(index, time, kept.images[k]);
    }
  }
  return run.finish();
}

void expectSameRun(const RunResult& a, const RunResult& b) {
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    EXPECT_EQ(a.frames[i].index, b.frames[i].index);
    EXPECT_EQ(a.frames[i].state, b.frames[i].state) << a.frames[i].index;
    EXPECT_EQ(a.frames[i].world_T_camera.translation, b.frames[i].world_T_camera.translation);
    EXPECT_EQ(a.frames[i].world_T_camera.rotation.coeffs(), b.frames[i].world_T_camera.rotation.coeffs());
    EXPECT_EQ(a.frames[i].final_world_T_camera.translation, b.frames[i].final_world_T_camera.translation);
    EXPECT_EQ(standardDeviation(a.frames[i]), standardDeviation(b.frames[i]));
  }
  ASSERT_EQ(a.keyframes.size(), b.keyframes.size());
  ASSERT_EQ(a.map_points.size(), b.map_points.size());
  for (std::size_t i = 0; i < a.map_points.size(); ++i) EXPECT_EQ(a.map_points[i].position, b.map_points[i].position);
}

TEST(LiveRun, WhatItDecidedRepeatsItToTheLastBit) {
  for (const int interval_ms : {12, 25, 4}) {  // the last is faster than tracking
    KeptDecisions kept;
    const LiveResult live = runLive(&kept, milliseconds(interval_ms), live_frames, true, /*unreadable=*/30);
    EXPECT_EQ(live.run.frames.size(), kept.frames.size());
    expectSameRun(live.run, repeat(kept));
  }
}

TEST(LiveRun, AMapComesToStandAndIsGoneOnWith) {
  const LiveResult live = runLive(nullptr, milliseconds(0));
  EXPECT_EQ(live.counts.passed_over, 0);
  int good = 0;
  for (const FrameRecord& frame : live.run.frames) good += isGoodPose(frame.state);
  EXPECT_GT(good, 15);
  EXPECT_GT(live.run.map_points.size(), 100U);
}

TEST(LiveRun, EveryFrameIsProcessedOrToldAsPassedOver) {
  KeptDecisions kept;
  RunRecord record(made().sequence.camera);
  LiveRun run(made().sequence.camera, Settings(), LiveOptions(), recordingTo(record), &kept);
  run.start();
  for (int i = 0; i < live_frames; ++i) handFrame(run, i);  // all at once
  run.stop(/*settle=*/true);
  const LiveCounts counts = run.counts();
  std::vector<std::int64_t> all = kept.frames;
  all.insert(all.end(), kept.passed_over.begin(), kept.passed_over.end());
  std::sort(all.begin(), all.end());
  ASSERT_FALSE(all.empty());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], static_cast<std::int64_t>(i));
  EXPECT_EQ(all.back(), live_frames - 1) << "the newest frame wins";
  EXPECT_GT(kept.passed_over.size(), 5U);
  EXPECT_EQ(counts.captured, live_frames);
  EXPECT_EQ(counts.processed + counts.passed_over, live_frames);
  EXPECT_EQ(counts.not_published, 0);
  EXPECT_EQ(static_cast<std::int64_t>(record.finish(run.mapper()).frames.size()), counts.processed);
}

TEST(LiveRun, EndsWithinASecondWhateverItIsDoing) {
  made();  // rendering them is not the run's time
  for (const int frames : {0, 1, 5, 20, 40, 50}) {
    const auto start = std::chrono::steady_clock::now();
    runLive(nullptr, milliseconds(10), frames, /*settle=*/false);
    const auto took = std::chrono::steady_clock::now() - start - milliseconds(10) * frames;
    EXPECT_LT(took, milliseconds(2000)) << frames << " frames";  // a loaded machine, sanitizers
  }
}

TEST(LiveRun, AMappingFarBehindIsToldNothingAndNoFrameIsDroppedForIt) {
  KeptDecisions kept;
  RunRecord record(made().sequence.camera);
  LiveRun live(made().sequence.camera, Settings(), LiveOptions(), recordingTo(record), &kept);
  live.start();
  // As fast as tracking goes: what starts a map takes longer than a few frames.
  for (int i = 0; i < live_frames; ++i) {
    handFrame(live, i);
    while (live.counts().processed + live.counts().passed_over <= i) std::this_thread::yield();
  }
  live.stop(/*settle=*/true);
  const LiveCounts counts = live.counts();
  EXPECT_GT(counts.mapping_behind, 0);
  EXPECT_EQ(static_cast<std::int64_t>(kept.decisions.mapping_busy.size()), counts.mapping_behind);
  EXPECT_EQ(counts.passed_over, 0);
  EXPECT_EQ(counts.processed, live_frames);
  expectSameRun(record.finish(live.mapper()), repeat(kept));
}

TEST(LiveRun, ACameraThatBurstsAndPausesGivesARunThatRepeats) {
  KeptDecisions kept;
  RunRecord record(made().sequence.camera);
  LiveRun live(made().sequence.camera, Settings(), LiveOptions(), recordingTo(record), &kept);
  live.start();
  for (int i = 0; i < live_frames; ++i) {
    handFrame(live, i);
    std::this_thread::sleep_for(i % 20 == 19 ? milliseconds(150) : i % 20 > 14 ? milliseconds(0) : milliseconds(20));
  }
  live.stop(/*settle=*/true);
  const LiveCounts counts = live.counts();
  EXPECT_EQ(counts.processed + counts.passed_over, live_frames);
  EXPECT_GT(counts.passed_over, 0) << "five frames at once";
  expectSameRun(record.finish(live.mapper()), repeat(kept));
}

TEST(LiveRun, APublisherThatIsStuckHoldsNothingUp) {
  std::atomic<bool> stuck{true};
  std::atomic<std::int64_t> published{0};
  LiveObserver observer;
  observer.frame = [&](const FrameResult&, const std::string&) {
    while (stuck.load()) std::this_thread::sleep_for(milliseconds(1));
    ++published;
  };
  LiveRun live(made().sequence.camera, Settings(), LiveOptions(), observer, nullptr);
  live.start();
  constexpr int more_than_its_queue = 300;
  for (int i = 0; i < more_than_its_queue; ++i) {
    handFrame(live, i);
    waitUntilIdle(live);
  }
  EXPECT_EQ(live.counts().processed, more_than_its_queue);
  EXPECT_GT(live.counts().not_published, 0);
  stuck = false;
  live.stop(/*settle=*/true);
  EXPECT_EQ(published + live.counts().not_published, more_than_its_queue);
}

TEST(LiveRun, TellsTheWorkAndTheWaitingOfEveryThread) {
  LiveRun live(made().sequence.camera, Settings(), LiveOptions(), {}, nullptr);
  live.start();
  for (int i = 0; i < 20; ++i) {
    handFrame(live, i);
    waitUntilIdle(live);
  }
  live.stop(/*settle=*/true);
  const std::vector<DurationSummary> durations = live.durations();
  const auto countOf = [&](const std::string& name) {
    for (const DurationSummary& duration : durations) {
      if (duration.name == name) return duration.count;
    }
    return std::int64_t{-1};
  };
  EXPECT_EQ(countOf("waiting for tracking"), 20);
  EXPECT_EQ(countOf("tracking"), 20);
  EXPECT_GE(countOf("mapping"), 1);
  EXPECT_EQ(countOf("waiting for mapping"), countOf("mapping"));
  EXPECT_EQ(countOf("waiting for places"), countOf("places"));
  EXPECT_EQ(countOf("publishing"), 20);
}

TEST(LiveOptions, FollowTheConfiguration) {
  ThreadOptions threads;
  threads.tracking_priority = 42;
  threads.mapping_nice = 7;
  threads.places_processor = 1;
  threads.lock_memory = true;
  const LiveOptions options = liveOptions(threads);
  EXPECT_EQ(options.tracking.real_time_priority, 42);
  EXPECT_EQ(options.mapping.nice, 7);
  EXPECT_EQ(options.places.processors, std::vector<int>{1});
  EXPECT_TRUE(options.places.batch);
  EXPECT_TRUE(options.tracking.processors.empty());
  EXPECT_TRUE(options.lock_memory);
}

TEST(LiveRun, AnUnreadableFrameIsOneOfTheRun) {
  KeptDecisions kept;
  const LiveResult live = runLive(&kept, milliseconds(0), 10, true, /*unreadable=*/4);
  EXPECT_EQ(live.run.unreadable_frames, 1);
}

TEST(LiveRun, TicksWithoutFramesAndTellsItsMap) {
  std::atomic<int> ticks{0};
  std::vector<std::shared_ptr<const Map>> maps;  // the publishing thread's
  std::atomic<std::size_t> map_count{0};
  LiveObserver observer;
  observer.tick = [&] { ++ticks; };
  observer.report = [&](const MappingReport& report) {
    if (!report.map) return;
    maps.push_back(report.map);
    ++map_count;
  };
  LiveRun live(made().sequence.camera, Settings(), LiveOptions(), observer, nullptr);
  live.start();
  const auto soon = [](const auto& condition) {
    for (int i = 0; i < 30000 && !condition(); ++i) std::this_thread::sleep_for(milliseconds(1));
    return condition();
  };
  live.askForMap();
  EXPECT_TRUE(soon([&] { return ticks >= 3 && map_count == 1; }));
  EXPECT_EQ(live.counts().map_changes, 0);
  for (int i = 0; i < 40; ++i) {
    FrameSlot& slot = live.nextSlot();
    slot.index = i;
    slot.time_ns = made().sequence.time(i);
    made().images[static_cast<std::size_t>(i)].copyTo(slot.grey);
    live.handOver();
    waitUntilIdle(live);
  }
  live.askForMap();
  EXPECT_TRUE(soon([&] { return map_count == 2; }));
  live.stop(/*settle=*/true);
  const LiveCounts counts = live.counts();
  ASSERT_EQ(maps.size(), 2U);
  EXPECT_TRUE(maps[0]->points.empty()) << "there was none yet";
  EXPECT_GT(counts.keyframes, 1U);
  EXPECT_EQ(counts.keyframes, live.mapper().map().keyframes.size());
  EXPECT_EQ(counts.points, live.mapper().map().points.size());
  EXPECT_GT(maps[1]->points.size(), 50U);
  EXPECT_GT(counts.map_changes, 5);
}

}  // namespace
}  // namespace edgeslam
