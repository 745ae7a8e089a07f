// Threads held up at random beside every queue: the run ends, nothing is lost and not told, and its recording repeats
// it to the last byte.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "recording/recording_source.h"
#include "system/daemon/daemon_fixture.h"
#include "system/program.h"

namespace edgeslam {
namespace {

class DelayedThreads : public DaemonTest, public testing::WithParamInterface<int> {
 protected:
  std::vector<std::string> delayed(const std::vector<std::string>& arguments) const {
    std::vector<std::string> command{"env", "LD_PRELOAD=" EDGESLAM_THREAD_DELAYS,
                                     "EDGESLAM_DELAY_SEED=" + std::to_string(GetParam()),
                                     "EDGESLAM_DELAY_REPORT=" + report_, EDGESLAM_PROGRAM};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return command;
  }
  // Or the test would show nothing.
  void expectThreadsWereDelayed() const {
    std::map<std::string, long> delays;
    std::istringstream lines(fileContent(report_));
    std::string thread, call;
    for (long calls = 0, delayed = 0; lines >> thread >> call >> calls >> delayed;) delays[thread] += delayed;
    for (const char* name : {"tracking", "mapping", "publishing", "recorder"}) {
      EXPECT_GT(delays[name], 0) << name << " in\n" << fileContent(report_);
    }
  }
  // Where the recorder, which stands back, could not write all, that is told.
  static void expectToldGaps(const Recording& recording, const std::string& said) {
    ASSERT_GT(recording.decisions.not_recorded, 0) << recording.decisions.note;
    EXPECT_NE(said.find("without " + std::to_string(recording.decisions.not_recorded) + " frames or decisions"),
              std::string::npos)
        << said;
  }

  const std::string small_ = std::string(EDGESLAM_RUN_FOLDER) + "/small";  // 60 frames, 2 s
  const std::string recording_ = folder_.path("recording"), again_ = folder_.path("again");
  const std::string report_ = folder_.path("delays");
};

TEST_P(DelayedThreads, GiveAReplayThatIsRepeatedToTheLastByte) {
  const std::string live = folder_.path("live");
  const Outcome outcome = runCommand(delayed(
      {"replay", small_, "--realtime", "--pace", "0.7", "--record", recording_, "--output", live, "--drawings", "0"}));
  ASSERT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 1) << outcome.exit_code << outcome.messages;
  expectThreadsWereDelayed();
  const auto summary = nlohmann::json::parse(fileContent(live + "/summary.json"));
  const Recording read = readRecording(recording_);
  if (!read.decisions.complete) return expectToldGaps(read, outcome.output + outcome.messages);
  EXPECT_EQ(static_cast<std::int64_t>(read.frames.size()), summary["frames"]["total"].get<std::int64_t>());
  EXPECT_EQ(read.frames.size() + read.decisions.dropped.size(), 60U);

  const Outcome repeated = runProgram({"replay", recording_, "--output", again_, "--drawings", "0"});
  EXPECT_EQ(repeated.exit_code, outcome.exit_code) << repeated.messages;
  for (const char* name : {"trajectory.txt", "trajectory_live.txt", "keyframes.txt", "map.ply"}) {
    EXPECT_TRUE(fileContent(live + "/" + name) == fileContent(again_ + "/" + name)) << name;
  }
}

TEST_P(DelayedThreads, GiveADaemonWhoseMapAndPosesAreRepeated) {
  const std::string map = folder_.path("robot.map"), map_again = folder_.path("again.map");
  BackgroundProcess daemon(delayed({"run", "--source", small_, "--record", recording_, "--map-out", map}));
  ASSERT_EQ(daemon.exitCode(), 0) << daemon.said();
  expectThreadsWereDelayed();
  ASSERT_TRUE(robot_->hears([](const Heard& heard) {
    return !heard.statuses.empty() && heard.statuses.back().frames_captured == 60;
  })) << daemon.said();
  const Heard heard = robot_->heard();
  for (std::size_t i = 1; i < heard.states.size(); ++i) ASSERT_GT(heard.states[i].utime, heard.states[i - 1].utime);
  EXPECT_EQ(static_cast<std::int64_t>(heard.states.size()), 60 - heard.statuses.back().frames_dropped);
  const Recording read = readRecording(recording_);
  if (!read.decisions.complete) return expectToldGaps(read, daemon.said());
  EXPECT_EQ(read.frames.size(), heard.states.size());

  const Outcome repeated =
      runProgram({"replay", recording_, "--output", again_, "--map-out", map_again, "--drawings", "0"});
  ASSERT_TRUE(repeated.exit_code == 0 || repeated.exit_code == 1) << repeated.messages;
  ASSERT_EQ(std::filesystem::exists(map), std::filesystem::exists(map_again)) << repeated.messages;
  EXPECT_TRUE(!std::filesystem::exists(map) || fileContent(map) == fileContent(map_again));
  std::map<std::int64_t, Pose> poses;
  for (const StampedPose& pose : readTrajectory(again_ + "/trajectory_live.txt")) {
    poses[pose.time_ns / 1000 * 1000] = pose.world_T_camera;
  }
  const Trajectory published = trajectoryOf(heard.states);
  EXPECT_EQ(published.size(), poses.size());
  for (const StampedPose& pose : published) {
    const auto found = poses.find(pose.time_ns);
    ASSERT_NE(found, poses.end()) << pose.time_ns;
    EXPECT_LT((found->second.translation - pose.world_T_camera.translation).norm(), 1e-6) << pose.time_ns;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, DelayedThreads, testing::Values(1, 2));

}  // namespace
}  // namespace edgeslam
