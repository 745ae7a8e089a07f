// Recordings fed through v4l2loopback into the daemon, in a virtual machine: the poses that it publishes are those of
// replaying the same frames, to the last bit.
#include <array>
#include <opencv2/core.hpp>

#include "configuration/configuration.h"
#include "drivers/lcm/messages.h"
#include "pipeline/lockstep_run.h"
#include "recording/recording_source.h"
#include "system/program.h"
#include "vm/loopback_daemon.h"

namespace edgeslam {
namespace {

class LoopbackPoses : public LoopbackDaemon {
 protected:
  // Runs the daemon on all frames of the sequence, with a recording. True where it went through.
  void run(const FedSequence& sequence) {
    const auto feeder = feed(sequence, FeedingOrder::once);
    feeder->hold(true);
    const auto daemon = start(sequence, {"--record", recording_});
    ASSERT_TRUE(hears([](const Heard& heard) { return heard.states.size() > 5; })) << daemon->said();
    feeder->hold(false);
    ASSERT_TRUE(comesTrue([&] { return feeder->ended(); }, patience_s));
    std::this_thread::sleep_for(std::chrono::seconds(3));
    daemon->send(SIGTERM);
    ASSERT_EQ(daemon->exitCode(), 0) << daemon->said();
    heard_ = robot_->heard();
    std::cout << daemon->said();
  }

  // By the number of the frame in the stream, its place in the sequence; told by its bytes. Not of those that came
  // while the first and the last one were held.
  std::map<std::int64_t, std::size_t> placesOf(const FedSequence& sequence) const {
    std::map<std::int64_t, std::size_t> places;
    RecordingSource source(readRecording(recording_));
    std::size_t next = 0;
    while (const std::optional<Frame> frame = source.next()) {
      std::size_t place = next;
      while (place < sequence.frames.size() && cv::norm(frame->grey, sequence.frames[place], cv::NORM_INF) != 0)
        ++place;
      EXPECT_LT(place, sequence.frames.size()) << "frame " << frame->index << " is none of those fed, or out of order";
      if (place >= sequence.frames.size()) break;
      if (place > 0 && (place > next || place + 1 < sequence.frames.size())) places[frame->index] = place;
      next = place;
    }
    return places;
  }

  const std::string recording_ = folder_.path("recording");
  Heard heard_;
};

// The recorded run, computed anew from its frames and decisions: a record for each frame.
std::map<std::int64_t, FrameRecord> repeated(const std::string& folder) {
  Recording recording = readRecording(folder);
  EXPECT_TRUE(recording.decisions.complete) << recording.decisions.note;
  RunDecisions decisions;
  for (const UpdateTaken& taken : recording.decisions.updates) decisions.updates[taken.frame_index] = taken.number;
  decisions.mapping_busy.insert(recording.decisions.busy.begin(), recording.decisions.busy.end());
  for (const CorrectionApplied& applied : recording.decisions.corrections) {
    decisions.corrections[applied.message].push_back(applied.number);
    decisions.snapshots.insert(applied.number);
  }
  LockstepRun run(recording.camera, readConfiguration(recording.configuration_path).settings, 0, 0);
  run.repeat(decisions);
  std::map<std::int64_t, FrameRecord> records;
  RecordingSource source(std::move(recording));
  while (const std::optional<Frame> frame = source.next()) {
    records[frame->index] = run.process(frame->index, frame->time_ns, frame->grey);
  }
  return records;
}

// What a message says of the camera's pose, and what it should: position, and quaternion w, x, y, z with w >= 0.
using PoseNumbers = std::array<double, 7>;
PoseNumbers numbersOf(const state_t& state) {
  const double* p = state.camera_position;
  const double* q = state.camera_orientation;
  return {p[0], p[1], p[2], q[0], q[1], q[2], q[3]};
}
PoseNumbers numbersOf(const Pose& world_T_camera) {
  const Eigen::Vector3d& p = world_T_camera.translation;
  const Eigen::Quaterniond q = world_T_camera.rotation.normalized();
  const double sign = q.w() < 0 ? -1 : 1;
  return {p.x(), p.y(), p.z(), sign * q.w(), sign * q.x(), sign * q.y(), sign * q.z()};
}

struct FedThrough {
  const char* name;
  const char* folder;  // variable of the environment
  double frames_per_second;
  std::size_t most_frames;
  double error_m;
};
void PrintTo(const FedThrough& fed, std::ostream* out) { *out << fed.name; }

class LoopbackPosesOf : public LoopbackPoses, public testing::WithParamInterface<FedThrough> {};

TEST_P(LoopbackPosesOf, AreThoseOfReplayingTheSameFramesToTheLastBit) {
  const FedThrough& fed = GetParam();
  if (environment(fed.folder).empty()) GTEST_SKIP() << "no sequence is named by " << fed.folder;
  const FedSequence sequence = readFedSequence(environment(fed.folder), fed.frames_per_second, fed.most_frames);
  run(sequence);
  if (HasFatalFailure()) return;

  // Every frame that the driver counted is accounted for, and is the one that was fed.
  const status_t& totals = heard_.statuses.back();
  const auto taken = static_cast<std::int64_t>(heard_.states.size());
  const std::int64_t counted = heard_.states.back().frame - heard_.states.front().frame + 1;
  const std::int64_t lost_by_driver = totals.frames_dropped - (totals.frames_captured - taken);
  EXPECT_EQ(totals.frames_captured + lost_by_driver, counted);
  EXPECT_EQ(totals.frames_unreadable, 0);
  const std::map<std::int64_t, std::size_t> places = placesOf(sequence);
  ASSERT_GT(places.size(), 10U);
  const auto offset = places.begin()->first - static_cast<std::int64_t>(places.begin()->second);
  for (const auto& [frame, place] : places) {
    ASSERT_EQ(frame - static_cast<std::int64_t>(place), offset) << "frame " << frame;
  }

  // The poses published are those of the run computed anew, to the bit.
  const std::map<std::int64_t, FrameRecord> again = repeated(recording_);
  EXPECT_EQ(again.size(), heard_.states.size());
  int same = 0, different = 0;
  for (const state_t& state : heard_.states) {
    const auto found = again.find(state.frame);
    ASSERT_NE(found, again.end()) << state.frame;
    EXPECT_EQ(state.state, stateNumber(found->second.state)) << state.frame;
    ASSERT_EQ(state.has_pose, found->second.has_pose) << state.frame;
    if (!state.has_pose) continue;
    ++(numbersOf(state) == numbersOf(found->second.world_T_camera) ? same : different);
  }
  EXPECT_EQ(different, 0);

  ASSERT_GT(same, 0) << "no map came to stand";

  // And those that `edgeslam replay` writes, to all digits of its file.
  const std::string result = folder_.path("result");
  const Outcome replay = runProgram({"replay", recording_, "--output", result, "--drawings", "0"});
  ASSERT_EQ(replay.exit_code, 0) << replay.messages;
  const Trajectory published = trajectoryOf(heard_.states);
  const Trajectory written = readTrajectory(result + "/trajectory_live.txt");
  ASSERT_EQ(written.size(), published.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    EXPECT_EQ(written[i].time_ns / 1000, published[i].time_ns / 1000);
    const Eigen::Vector3d& p = published[i].world_T_camera.translation;
    EXPECT_LT((written[i].world_T_camera.translation - p).norm(), 1e-8 * (1 + p.norm()));
  }

  std::size_t compared = 0;
  ASSERT_GT(published.size(), sequence.frames.size() / 4);
  const double error_m = errorOf(heard_.states, places, sequence, compared);
  std::cout << sequence.frames.size() << " frames fed at " << fed.frames_per_second << "/s: " << counted
            << " counted by the driver, " << lost_by_driver << " lost there, " << totals.frames_captured - taken
            << " passed over, " << taken << " tracked; " << published.size() << " poses published, " << same
            << " the same to the bit when computed anew, " << different << " not; error against the truth "
            << 100 * error_m << " cm (RMSE of " << compared << ")\n";
  EXPECT_GT(compared, sequence.frames.size() / 4);
  EXPECT_LT(error_m, fed.error_m);
}

INSTANTIATE_TEST_SUITE_P(Sequences, LoopbackPosesOf,
                         testing::Values(FedThrough{"Simulated", "EDGESLAM_SEQUENCE", 2, 1000, 0.02},
                                         FedThrough{"Shared", "EDGESLAM_SHARED_SEQUENCE", 1, 120, 0.05}),
                         [](const auto& fed) { return fed.param.name; });

}  // namespace
}  // namespace edgeslam
