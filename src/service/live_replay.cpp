#include "service/live_replay.h"

#include <chrono>
#include <exception>
#include <iostream>
#include <memory>
#include <thread>
#include <utility>

#include "frames/frame_problem.h"
#include "inertia/found_time_offset.h"
#include "map/saved_map.h"
#include "pipeline/live_run.h"
#include "pipeline/run_record.h"
#include "recording/flight_recorder.h"
#include "recording/recording_layout.h"
#include "samples/sample_feed.h"
#include "service/failure_message.h"
#include "service/run_publisher.h"

namespace edgeslam {
namespace {

using Clock = std::chrono::steady_clock;

// One line for all that was not allowed.
void tell(const std::vector<RefusedSetup>& problems) {
  if (problems.empty()) return;
  std::cerr << "edgeslam: runs on without ";
  for (const RefusedSetup& problem : problems) {
    std::cerr << (&problem == &problems.front() ? "" : "; ") << problem.text;
  }
  std::cerr << " (threads: in the configuration)\n";
}

// With the recording of a run that goes on with it: otherwise it could not be repeated.
void keepMap(const Map& map, const Camera& camera, const std::string& folder) {
  try {
    saveMap(folder + "/" + recording_map_name, camera, map);
  } catch (const std::exception& error) {
    std::cerr << "edgeslam: the recording will not repeat the run, its map is not with it: " << failureMessage(error)
              << "\n";
  }
}

// Each frame at its time, and before it what was measured until then; up to the last one, or the end asked for.
void feed(FrameSource& source, const Camera& camera, const LiveReplay& replay, std::int64_t imu_offset_ns,
          LiveRun& run) {
  SampleFeed inertia(replay.inertia, imu_offset_ns + farthest_time_offset_ns);  // it may be found to be later
  SampleFeed wheels(replay.wheels);
  std::optional<Clock::time_point> start;
  std::int64_t first_ns = 0;
  while (!replay.is_to_end || !replay.is_to_end()) {
    std::optional<Frame> frame = source.next();
    if (!frame) return;
    if (!start) {
      start = Clock::now();
      first_ns = frame->time_ns;
    }
    FrameSlot& slot = run.nextSlot();
    slot.index = frame->index;
    slot.time_ns = frame->time_ns;
    slot.problem = frameProblem(*frame, camera);
    if (slot.problem.empty()) frame->grey.copyTo(slot.grey);
    const auto since_start = static_cast<std::int64_t>(static_cast<double>(frame->time_ns - first_ns) / replay.pace);
    std::this_thread::sleep_until(*start + std::chrono::nanoseconds(since_start));
    inertia.giveUntil(frame->time_ns, [&](const InertialSample& sample) { run.add(sample); });
    wheels.giveUntil(frame->time_ns, [&](const OdometryPose& pose) { run.add(pose); });
    run.handOver();
  }
}

}  // namespace

LiveReplayResult replayLive(FrameSource& source, const Camera& camera, const Settings& settings,
                            const LiveReplay& replay) {
  std::shared_ptr<FlightRecorder> recorder;
  if (!replay.record_folder.empty()) {
    recorder =
        std::make_shared<FlightRecorder>(replay.record_folder, replay.description, recordingLimits(settings.recording));
    if (replay.map_in) keepMap(*replay.map_in, camera, replay.record_folder);
  }
  RunRecord record(camera, settings.tracking.location.pose);
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

  LiveRun run(camera, settings, liveOptions(settings.threads), observer, recorder.get());
  if (replay.map_in) {
    record.goOnFrom(replay.map_in->keyframes.back().id + 1);
    run.goOnWith(*replay.map_in);
  }
  if (replay.publisher) {
    replay.publisher->begin(run, recorder, replay.map_in ? RunStart::saved_map : RunStart::new_map);
  }
  run.start();
  std::vector<RefusedSetup> problems = run.problems();
  if (const auto refused = setUpThread({"capture", settings.threads.capture_priority, 0, false, {}})) {
    problems.push_back(*refused);
  }
  tell(problems);
  const std::optional<InertialUnit>& unit = settings.tracking.inertia;
  feed(source, camera, replay, unit ? unit->offset_ns : 0, run);
  setUpThread({"edgeslam", 0, 0, false, {}});
  run.stop(/*settle=*/!replay.is_to_end || !replay.is_to_end());
  if (replay.publisher) replay.publisher->end(/*is_last=*/true);

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
