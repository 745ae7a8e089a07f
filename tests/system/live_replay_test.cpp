// A live run through the program, its recording, and the run repeated from it.
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>

#include "system/program.h"

namespace edgeslam {
namespace {

const std::string hall = std::string(EDGESLAM_RUN_FOLDER) + "/hall";

TEST(LiveReplay, ARecordingRepeatsTheRunUnderLoadToTheLastByte) {
  const TemporaryFolder folder;
  std::atomic<bool> done{false};
  std::vector<std::thread> load;  // burns every processor
  for (unsigned i = 0; i < std::thread::hardware_concurrency(); ++i) {
    load.emplace_back([&done] {
      while (!done) continue;
    });
  }
  // At 60 frames/s.
  const Outcome live = runProgram({"replay", hall, "--realtime", "--pace", "2", "--record", folder.path("recording"),
                                   "--output", folder.path("live"), "--drawings", "0"});
  done = true;
  for (std::thread& thread : load) thread.join();
  ASSERT_EQ(live.exit_code, 0) << live.messages;
  EXPECT_NE(live.messages.find("ended with the run\n"), std::string::npos) << "with gaps: " << live.messages;
  const Outcome repeated =
      runProgram({"replay", folder.path("recording"), "--output", folder.path("repeated"), "--drawings", "0"});
  ASSERT_EQ(repeated.exit_code, 0) << repeated.messages;
  // On a machine as loaded as this the map may come to stand late, but it does.
  EXPECT_GT(fileContent(folder.path("live") + "/trajectory.txt").size(), 200U);
  for (const char* name : {"trajectory.txt", "trajectory_live.txt", "keyframes.txt", "map.ply"}) {
    const std::string content = fileContent(folder.path("live") + "/" + name);
    EXPECT_TRUE(content == fileContent(folder.path("repeated") + "/" + name))
        << name << "; live: " << live.messages << "; repeated: " << repeated.messages;
  }
}

TEST(LiveReplay, OnlyWhatRunsLiveIsRecorded) {
  const TemporaryFolder folder;
  const Outcome outcome = runProgram({"replay", hall, "--record", folder.path("recording")});
  EXPECT_EQ(outcome.exit_code, 2);
  ASSERT_EQ(outcome.failures().size(), 1U) << outcome.messages;
  EXPECT_NE(outcome.failures()[0].find("--realtime"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder.path("recording")));
}

TEST(LiveReplay, AFolderThatIsNotEmptyIsNoPlaceForARecording) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path("recording"));
  std::ofstream(folder.path("recording/mine.txt")) << "kept";
  const Outcome outcome = runProgram(
      {"replay", hall, "--realtime", "--record", folder.path("recording"), "--output", folder.path("result")});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.failures().size(), 1U) << outcome.messages;
  EXPECT_EQ(fileContent(folder.path("recording/mine.txt")), "kept");
}

}  // namespace
}  // namespace edgeslam
