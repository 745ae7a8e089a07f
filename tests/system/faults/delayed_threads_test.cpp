// Threads held up at random beside every queue: the run ends, nothing is lost and not told, and its recording repeats
// it to the last byte.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "dataset/recording_source.h"
#include "system/program.h"

namespace edgeslam {
namespace {

const std::string small = std::string(EDGESLAM_RUN_FOLDER) + "/small";
constexpr std::int64_t small_frames = 60;

class DelayedThreads : public testing::TestWithParam<int> {};

TEST_P(DelayedThreads, GiveARunThatIsRepeatedToTheLastByte) {
  const TemporaryFolder folder;
  const std::string recording = folder.path("recording");
  const Outcome live =
      runCommand({"env", "LD_PRELOAD=" EDGESLAM_THREAD_DELAYS, "EDGESLAM_DELAY_SEED=" + std::to_string(GetParam()),
                  "timeout", "--signal=KILL", "100", EDGESLAM_PROGRAM, "replay", small, "--realtime", "--record",
                  recording, "--output", folder.path("live"), "--drawings", "0"});
  ASSERT_NE(live.exit_code, -1) << "it does not end: " << live.messages;
  ASSERT_NE(live.exit_code, 2) << live.messages;
  const auto summary = nlohmann::json::parse(fileContent(folder.path("live/summary.json")));
  const Recording read = readRecording(recording);
  EXPECT_TRUE(read.decisions.complete) << read.decisions.note;
  const auto processed = summary["frames"]["total"].get<std::int64_t>();
  EXPECT_EQ(static_cast<std::int64_t>(read.frames.size()), processed);
  EXPECT_EQ(processed + static_cast<std::int64_t>(read.decisions.dropped.size()), small_frames);
  EXPECT_EQ(live.output.find("dropped") == std::string::npos, read.decisions.dropped.empty()) << live.output;

  const Outcome again = runProgram({"replay", recording, "--output", folder.path("again"), "--drawings", "0"});
  EXPECT_EQ(again.exit_code, live.exit_code) << again.messages;
  for (const char* name : {"trajectory.txt", "trajectory_live.txt", "keyframes.txt", "map.ply"}) {
    EXPECT_TRUE(fileContent(folder.path("live") + "/" + name) == fileContent(folder.path("again") + "/" + name))
        << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, DelayedThreads, testing::Range(1, 7));

}  // namespace
}  // namespace edgeslam
