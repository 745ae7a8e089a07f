// On the way from a frame to its pose there is no allocation, no lock and no system call but the clock (design, section
// 4): the tracking thread of a live run is watched over whole sequences, with losses and what follows.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>

#include "frames/frame_source.h"
#include "pipeline/live_run.h"
#include "pipeline/lockstep_run.h"
#include "realtime/watched_thread.h"
#include "recording/open_frame_source.h"
#include "samples/sample_feed.h"
#include "simulator/inertial_simulation.h"
#include "simulator/simulator.h"
#include "simulator/wheel_simulation.h"

namespace edgeslam {
namespace {

struct WatchedRun {
  Trespasses trespasses;
  int good = 0, lost = 0, found_again = 0;
  int looks = 0, looks_at_lost_frames = 0;  // taken by someone who looks on
};

// Stands for the viewer: takes as many looks as it can.
class Onlooker {
 public:
  explicit Onlooker(WatchedRun& result) : result_(result), thread_([this] { look(); }) {}
  ~Onlooker() {
    ended_ = true;
    thread_.join();
  }
  Onlooker(const Onlooker&) = delete;
  Onlooker& operator=(const Onlooker&) = delete;
  FrameLooks& looks() { return looks_; }

 private:
  void look() {
    while (!ended_) {
      looks_.ask();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (!looks_.take()) continue;
      const FrameLook& look = looks_.look();
      ++result_.looks;
      EXPECT_NE(look.images, nullptr);
      result_.looks_at_lost_frames += look.state == TrackingState::lost && look.tracks.empty();
      looks_.letGo();
    }
  }

  WatchedRun& result_;
  FrameLooks looks_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

// Stands for the flight recorder.
class NoRecorder : public DecisionSink {
 public:
  void tookUpdate(std::int64_t, std::int64_t) noexcept override {}
  void mappingBusy(std::int64_t) noexcept override {}
  void measured(std::int64_t, const InertialSample&) noexcept override {}
  void measured(std::int64_t, const OdometryPose&) noexcept override {}
  void appliedCorrection(std::int64_t, std::int64_t) noexcept override {}
  void passedOver(std::int64_t, std::int64_t) noexcept override {}
  void processed(const std::shared_ptr<const FrameImages>& images, const CameraJpeg& /*jpeg*/) noexcept override {
    last_ = images;
  }
  void unreadable(std::int64_t, std::int64_t, const std::string&) noexcept override {}

 private:
  std::shared_ptr<const FrameImages> last_;
};

// Each frame waits until tracking and mapping are done with the one before, so that none is passed over.
void feed(LiveRun& run, std::int64_t index, std::int64_t time_ns, const cv::Mat& grey, const std::string& problem) {
  FrameSlot& slot = run.nextSlot();
  slot.index = index;
  slot.time_ns = time_ns;
  slot.problem = problem;
  if (problem.empty()) grey.copyTo(slot.grey);
  run.handOver();
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (std::chrono::steady_clock::now() < end) {
    const LiveCounts counts = run.counts();
    if (counts.processed + counts.passed_over == counts.captured && counts.messages_waiting == 0) return;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}

// `frozen`: a map that is only localised in; none: one is made.
template <typename FeedAll>
WatchedRun watch(const Camera& camera, const FeedAll& feedAll, bool is_looked_at = false,
                 const std::optional<Map>& frozen = std::nullopt, const Settings& given = {}) {
  WatchedRun result;
  std::optional<Onlooker> onlooker;
  if (is_looked_at) onlooker.emplace(result);
  LiveObserver observer;
  observer.frame = [&](const FrameResult& frame, const std::string&) {
    result.good += isGoodPose(frame.state);
    result.lost += frame.state == TrackingState::lost;
    result.found_again += frame.state == TrackingState::relocalised || frame.state == TrackingState::recovered;
  };
  NoRecorder recorder;
  LiveOptions options;
  watchThreadNamed(options.tracking.name);
  Settings settings = given;
  settings.tracking.map_is_frozen = frozen.has_value();
  LiveRun run(camera, settings, options, observer, &recorder);
  if (frozen) run.goOnWith(*frozen);
  if (onlooker) run.showTo(onlooker->looks());
  run.start();
  feedAll(run);
  result.trespasses = takeTrespasses();
  run.stop(/*settle=*/false);
  return result;
}

void expectNone(const Trespasses& trespasses) {
  EXPECT_EQ(trespasses.allocations, 0) << trespasses.where;
  EXPECT_EQ(trespasses.releases, 0) << trespasses.where;
  EXPECT_EQ(trespasses.locks, 0) << trespasses.where;
  EXPECT_EQ(trespasses.system_calls, 0) << trespasses.where;
}

TEST(TrackingThread, TheWatchSeesWhatIsForbidden) {
  if (!canWatchThreads()) GTEST_SKIP() << "not under sanitizers";
  watchThreadNamed("trespasser");
  std::thread thread([] {
    pthread_setname_np(pthread_self(), "trespasser");
    std::mutex mutex;
    mutex.lock();
    mutex.unlock();
    void* volatile memory = std::malloc(100);
    std::free(memory);
    [[maybe_unused]] const auto parent = getppid();
  });
  thread.join();
  const Trespasses seen = takeTrespasses();
  EXPECT_GE(seen.allocations, 1);
  EXPECT_GE(seen.releases, 1);
  EXPECT_EQ(seen.locks, 1);
  EXPECT_EQ(seen.system_calls, 1);
  EXPECT_NE(seen.where, "");
}

// With a covered lens and a shake in it.
SimulatedSequence troubledSequence(SceneKind scene = SceneKind::room) {
  SimulationOptions simulation;
  simulation.scene = scene;
  simulation.frames = 200;
  simulation.width = 320;
  simulation.height = 240;
  simulation.speed = 1.5;
  simulation.covered = {{90, 40}};
  simulation.shaken = {{60, 4}};
  return makeSequence(simulation);
}

void feedAll(const SimulatedSequence& sequence, LiveRun& run) {
  for (int i = 0; i < sequence.size(); ++i) {
    const SimulatedFrame frame = sequence.frame(i);
    feed(run, i, frame.time_ns, frame.grey, i == 70 ? "torn" : "");
  }
}

TEST(TrackingThread, NeitherAllocatesNorLocksNorCallsTheSystem) {
  if (!canWatchThreads()) GTEST_SKIP() << "not under sanitizers";
  const SimulatedSequence sequence = troubledSequence();
  const WatchedRun run = watch(sequence.camera, [&](LiveRun& live) { feedAll(sequence, live); });
  expectNone(run.trespasses);
  EXPECT_GT(run.good, 40);
}

TEST(TrackingThread, NorWhileSomeoneLooksOn) {
  if (!canWatchThreads()) GTEST_SKIP() << "not under sanitizers";
  const SimulatedSequence sequence = troubledSequence();
  const WatchedRun run = watch(
      sequence.camera, [&](LiveRun& live) { feedAll(sequence, live); }, /*is_looked_at=*/true);
  expectNone(run.trespasses);
  EXPECT_GT(run.good, 40);
  EXPECT_GT(run.looks, 40);
  EXPECT_GT(run.looks_at_lost_frames, 0);
}

// Nor with wheels, which carry the camera while its lens is covered.
TEST(TrackingThread, NorWithWheels) {
  if (!canWatchThreads()) GTEST_SKIP() << "not under sanitizers";
  const SimulatedSequence sequence = troubledSequence(SceneKind::panels_textured);
  const std::vector<OdometryPose> wheels = simulateWheels(sequence);
  Settings settings;
  useWheels({}, settings);
  const WatchedRun run = watch(
      sequence.camera,
      [&](LiveRun& live) {
        SampleFeed feed_of_wheels(wheels);
        for (int i = 0; i < sequence.size(); ++i) {
          const SimulatedFrame frame = sequence.frame(i);
          feed_of_wheels.giveUntil(frame.time_ns, [&](const OdometryPose& pose) { live.add(pose); });
          feed(live, i, frame.time_ns, frame.grey, i == 70 ? "torn" : "");
        }
      },
      /*is_looked_at=*/false, std::nullopt, settings);
  expectNone(run.trespasses);
  EXPECT_GT(run.good, 120) << "the lens is covered for 40 frames";
}

// Nor with an inertial unit: keyframes bring mapping what it felt.
TEST(TrackingThread, NorWithAnInertialUnit) {
  if (!canWatchThreads()) GTEST_SKIP() << "not under sanitizers";
  const SimulatedSequence sequence = troubledSequence(SceneKind::panels_textured);
  const std::vector<InertialSample> samples = simulateInertia(sequence);
  const InertialUnit unit = simulatedUnit();
  Settings settings;
  useInertia(unit, settings);
  const WatchedRun run = watch(
      sequence.camera,
      [&](LiveRun& live) {
        SampleFeed feed_of_unit(samples, farthest_time_offset_ns);
        for (int i = 0; i < sequence.size(); ++i) {
          const SimulatedFrame frame = sequence.frame(i);
          feed_of_unit.giveUntil(frame.time_ns, [&](const InertialSample& sample) { live.add(sample); });
          feed(live, i, frame.time_ns, frame.grey, i == 70 ? "torn" : "");
        }
      },
      /*is_looked_at=*/false, std::nullopt, settings);
  expectNone(run.trespasses);
  EXPECT_GT(run.good, 40);
}

// Nor where a map is only localised in: with other views of it taken over, predicted, lost and found again.
TEST(TrackingThread, NorInAFrozenMap) {
  if (!canWatchThreads()) GTEST_SKIP() << "not under sanitizers";
  const SimulatedSequence sequence = troubledSequence();
  LockstepRun mapping(sequence.camera, Settings(), sequence.size(), 0);
  for (int i = 0; i < sequence.size(); ++i) {
    const SimulatedFrame frame = sequence.frame(i);
    mapping.process(i, frame.time_ns, frame.grey);
  }
  mapping.settle();
  ASSERT_FALSE(mapping.map().keyframes.empty());
  const WatchedRun run = watch(
      sequence.camera, [&](LiveRun& live) { feedAll(sequence, live); }, /*is_looked_at=*/false, mapping.map());
  expectNone(run.trespasses);
  EXPECT_GT(run.good, 40);
  EXPECT_GT(run.lost, 0);
  EXPECT_GT(run.found_again, 1);
}

// Real images, with losses and new maps among them.
TEST(TrackingThread, OnRealImagesLikewise) {
  if (!canWatchThreads()) GTEST_SKIP() << "not under sanitizers";
  const std::filesystem::path folder =
      std::filesystem::path(EDGESLAM_SOURCE_DIR).parent_path() / "shared" / "data" / "phone_room_real";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared sequences here: " << folder;
  const std::unique_ptr<FrameSource> source = openFrameSource(folder.string());
  const WatchedRun run = watch(*source->camera(), [&](LiveRun& live) {
    while (const std::optional<Frame> frame = source->next()) feed(live, frame->index, frame->time_ns, frame->grey, "");
  });
  expectNone(run.trespasses);
  EXPECT_GT(run.good, 300);
  EXPECT_GT(run.lost + run.found_again, 0) << "a sequence without losses proves less";
}

}  // namespace
}  // namespace edgeslam
