#include "app/live_replay.h"

#include <chrono>
#include <iostream>
#include <memory>
#include <thread>
#include <utility>

#include "app/flight_recorder.h"
#include "app/frame_problem.h"
#include "app/run_publisher.h"
#include "pipeline/live_run.h"
#include "pipeline/run_record.h"

namespace edgeslam {
namespace {

using Clock = std::chrono::steady_clock;

// Each frame at its time.
void feed(FrameSource& source, const Camera& camera, LiveRun& run) {
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
    std::this_thread::sleep_until(*start + std::chrono::nanoseconds(frame->time_ns - first_ns));
    run.handOver();
  }
}

}  // namespace

LiveReplayResult replayLive(FrameSource& source, const Camera& camera, const Settings& settings,
                            const LiveReplay& replay) {
  std::shared_ptr<FlightRecorder> recorder;
  if (!replay.record_folder.empty()) {
    recorder = std::make_shared<FlightRecorder>(replay.record_folder, replay.description);
  }
  RunRecord record(camera);
  LiveObserver observer;
  observer.frame = [&](const FrameResult& result, const std::string& problem) {
    record.add(result, !problem.empty());
    if (replay.publisher) replay.publisher->frame(result, problem);
    if (replay.progress) replay.progress(result, problem);
  };
  observer.report = [&](const MappingReport& report) {
    record.add(report);
    if (replay.publisher) replay.publisher->report(report);
  };
  if (replay.publisher) observer.tick = [&] { replay.publisher->tick(); };

  LiveRun run(camera, settings, LiveOptions(), observer, recorder.get());
  if (replay.map_in) {
    record.goOnFrom(replay.map_in->keyframes.back().id + 1);
    run.goOnWith(*replay.map_in);
  }
  if (replay.publisher) {
    replay.publisher->begin(run, recorder, replay.map_in ? RunStart::saved_map : RunStart::new_map);
  }
  run.start();
  for (const std::string& problem : run.problems()) std::cerr << "edgeslam: " << problem << "\n";
  feed(source, camera, run);
  run.stop(/*settle=*/true);
  if (replay.publisher) replay.publisher->end();

  LiveReplayResult result;
  const LiveCounts counts = run.counts();
  result.run = record.finish(run.mapper());
  result.run.dropped_frames = counts.passed_over;
  result.map = run.mapper().map();
  if (recorder) {
    const RecordingStatus status = recorder->stop();
    result.recording = status.message;
  }
  return result;
}

}  // namespace edgeslam
