#include "app/live_replay.h"

#include <chrono>
#include <iostream>
#include <memory>
#include <thread>
#include <utility>

#include "app/frame_problem.h"
#include "dataset/recording_thread.h"
#include "pipeline/live_run.h"
#include "pipeline/run_record.h"

namespace edgeslam {
namespace {

using Clock = std::chrono::steady_clock;

std::int64_t bytesOf(double megabytes) { return static_cast<std::int64_t>(megabytes * (1 << 20)); }

// Hands the run's decisions to the flight recorder.
class Recorder : public DecisionSink {
 public:
  Recorder(const std::string& folder, const RecordingDescription& description, const RecordingSpace& space)
      : thread_(folder, description, {bytesOf(space.most_megabytes), bytesOf(space.kept_free_megabytes)}) {}

  void tookUpdate(std::int64_t frame_index, std::int64_t number) noexcept override {
    postNumbered(DecisionKind::update, frame_index, number);
  }
  void mappingBusy(std::int64_t frame_index) noexcept override { postNumbered(DecisionKind::busy, frame_index, 0); }
  void appliedCorrection(std::int64_t message, std::int64_t number) noexcept override {
    postNumbered(DecisionKind::correction, message, number);
  }
  void passedOver(std::int64_t index, std::int64_t time_ns) noexcept override {
    RecordingEntry entry;
    entry.kind = DecisionKind::dropped;
    entry.index = index;
    entry.time_ns = time_ns;
    thread_.post(std::move(entry));
  }
  void processed(const std::shared_ptr<const FrameImages>& images) noexcept override {
    RecordingEntry entry;
    entry.images = images;
    entry.index = images->frame_index;
    entry.time_ns = images->time_ns;
    thread_.post(std::move(entry));
  }
  void unreadable(std::int64_t index, std::int64_t time_ns, const std::string& problem) noexcept override {
    thread_.post(unreadableFrameEntry(index, time_ns, problem));
  }

  RecordingStatus stop() { return thread_.stop(); }

 private:
  void postNumbered(DecisionKind kind, std::int64_t index, std::int64_t number) noexcept {
    RecordingEntry entry;
    entry.kind = kind;
    entry.index = index;
    entry.number = number;
    thread_.post(std::move(entry));
  }

  RecordingThread thread_;
};

// One line for all that was not allowed.
void tell(const std::vector<std::string>& problems) {
  if (problems.empty()) return;
  std::cerr << "edgeslam: runs on without ";
  for (const std::string& problem : problems) std::cerr << (&problem == &problems.front() ? "" : "; ") << problem;
  std::cerr << " (threads: in the configuration)\n";
}

// Each frame at its time.
void feed(FrameSource& source, const Camera& camera, double pace, LiveRun& run) {
  std::optional<Clock::time_point> start;
  std::int64_t first_ns = 0;
  while (std::optional<Frame> frame = source.next()) {
    if (!start) {
      start = Clock::now();
      first_ns = frame->time_ns;
    }
    FrameSlot& slot = run.nextSlot();
    slot.index = frame->index;
    slot.time_ns = frame->time_ns;
    slot.problem = frameProblem(*frame, camera);
    if (slot.problem.empty()) frame->grey.copyTo(slot.grey);
    const auto since_start = static_cast<std::int64_t>(static_cast<double>(frame->time_ns - first_ns) / pace);
    std::this_thread::sleep_until(*start + std::chrono::nanoseconds(since_start));
    run.handOver();
  }
}

}  // namespace

LiveReplayResult replayLive(FrameSource& source, const Camera& camera, const Settings& settings,
                            const LiveReplay& replay) {
  std::unique_ptr<Recorder> recorder;
  if (!replay.record_folder.empty())
    recorder = std::make_unique<Recorder>(replay.record_folder, replay.description, settings.recording);
  RunRecord record(camera);
  LiveObserver observer;
  observer.frame = [&](const FrameResult& result, const std::string& problem) {
    record.add(result, !problem.empty());
    if (replay.progress) replay.progress(result, problem);
  };
  observer.report = [&](const MappingReport& report) { record.add(report); };

  LiveRun run(camera, settings, liveOptions(settings.threads), observer, recorder.get());
  if (replay.map_in) {
    record.goOnFrom(replay.map_in->keyframes.back().id + 1);
    run.goOnWith(*replay.map_in);
  }
  run.start();
  std::vector<std::string> problems = run.problems();
  const std::string refused = setUpThread({"capture", settings.threads.capture_priority, 0, false, {}});
  if (!refused.empty()) problems.push_back(refused);
  tell(problems);
  feed(source, camera, replay.pace, run);
  setUpThread({"edgeslam", 0, 0, false, {}});
  run.stop(/*settle=*/true);

  LiveReplayResult result;
  const LiveCounts counts = run.counts();
  result.run = record.finish(run.mapper());
  result.run.pace = replay.pace;
  result.run.dropped_frames = counts.passed_over;
  result.run.thread_durations = run.durations();
  result.map = run.mapper().map();
  if (recorder) {
    const RecordingStatus status = recorder->stop();
    result.recording = status.message;
  }
  return result;
}

}  // namespace edgeslam
