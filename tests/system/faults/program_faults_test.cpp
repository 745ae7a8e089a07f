// The whole program where the power goes or the memory ends: what it had saved is there, and what it says is one line.
#include <gtest/gtest.h>

#include "frames/frame_source.h"
#include "map/saved_map.h"
#include "recording/open_frame_source.h"
#include "recording/recording_source.h"
#include "system/faults/file_faults.h"
#include "system/program.h"

namespace edgeslam {
namespace {

namespace fs = std::filesystem;

const std::string small = std::string(EDGESLAM_RUN_FOLDER) + "/small";  // 60 frames

Outcome runWithFaults(const FaultPlan& plan, const std::vector<std::string>& arguments) {
  std::vector<std::string> command{"env"};
  for (const std::string& variable : faultEnvironment(EDGESLAM_FILE_FAULTS, plan)) command.push_back(variable);
  command.emplace_back(EDGESLAM_PROGRAM);
  command.insert(command.end(), arguments.begin(), arguments.end());
  return runCommand(command);
}

class ProgramFaults : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }
  std::vector<std::string> replay(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"replay", small, "--output", path("result"), "--drawings", "0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  const TemporaryFolder folder_;
};

TEST_F(ProgramFaults, APowerCutWhileTheMapIsSavedLeavesTheMapBefore) {
  const Camera camera = *openFrameSource(small)->camera();
  fs::create_directory(path("maps"));
  const std::string map = path("maps/hall.map");
  FaultPlan plan;
  plan.under = path("maps");
  plan.log = path("log");
  ASSERT_EQ(runWithFaults(plan, replay({"--map-out", map})).exit_code, 0);
  const std::string before = fileContent(map), log = fileContent(plan.log);
  const long steps = std::count(log.begin(), log.end(), '\n');
  const std::size_t written = log.rfind(" write "), renamed = log.rfind(" rename ");
  ASSERT_NE(written, std::string::npos) << log;
  ASSERT_LT(log.find(" fsync ", written), renamed) << log;
  ASSERT_GT(log.rfind(" fsync "), renamed) << log;

  // Written, synced, renamed, closed, the folder synced and closed.
  for (const long step : {steps - 5, steps - 4, steps - 3}) {
    plan.fault = Fault::cut_within;
    plan.first = step;
    const Outcome outcome = runWithFaults(plan, replay({"--map-in", map, "--map-out", map}));
    EXPECT_EQ(outcome.exit_code, -1) << "step " << step << ": " << outcome.messages;
    EXPECT_FALSE(loadMap(map, camera).points.empty());
    EXPECT_TRUE(fileContent(map) == before || step == steps - 3) << "step " << step;
  }
}

TEST_F(ProgramFaults, ARecordingOfARunThatWasCutIsRepeatedAsFarAsItReaches) {
  std::size_t most = 0;
  for (const long step : {60, 140, 200}) {
    const std::string recording = path("recording" + std::to_string(step));
    FaultPlan plan;
    plan.under = recording;
    plan.fault = Fault::cut_within;
    plan.first = step;
    const Outcome live = runWithFaults(plan, replay({"--realtime", "--record", recording}));
    ASSERT_EQ(live.exit_code, -1) << live.messages;
    const Recording read = readRecording(recording);
    EXPECT_FALSE(read.decisions.complete);
    most = std::max(most, read.frames.size());
    const Outcome again = runProgram({"replay", recording, "--output", path("again"), "--drawings", "0"});
    EXPECT_EQ(again.exit_code == 2, read.frames.empty()) << again.messages;
    ASSERT_FALSE(again.failures().empty());
    const std::string told = again.failures().front();
    EXPECT_TRUE(told.find("breaks off without the run's end") != std::string::npos ||
                told.find("torn or damaged") != std::string::npos)
        << again.messages;
  }
  EXPECT_GT(most, 20U);
}

Outcome runWithin(int megabytes, const std::vector<std::string>& arguments) {
  std::vector<std::string> command{"env", "LD_PRELOAD=" EDGESLAM_CRASH_PLACE, "prlimit",
                                   "--as=" + std::to_string(std::int64_t{megabytes} << 20), EDGESLAM_PROGRAM};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return runCommand(command);
}

// From so little memory that the libraries are just loaded (with less, theirs end before the program begins) to enough.
TEST_F(ProgramFaults, WithoutMemoryEndsWithOneMessage) {
  int least = 40;
  while (runWithin(least, {"--version"}).exit_code != 0) ASSERT_LT(least += 8, 2000);
  least += 8;  // how much they take differs from start to start
  int without = 0, with = 0;
  for (const std::vector<std::string>& how :
       {std::vector<std::string>{}, {"--realtime", "--pace", "4", "--record", path("recording")}}) {
    for (int more = 0; more <= 240; more += more < 80 ? 10 : 80) {
      SCOPED_TRACE(std::to_string(least) + " + " + std::to_string(more) + " MiB");
      fs::remove_all(path("recording"));
      const Outcome outcome = runWithin(least + more, replay(how));
      if (outcome.exit_code == 0) {
        ++with;
        continue;
      }
      ++without;
      // GDAL, which OpenCV brings, ends the program by itself where it cannot make its lock, before ours is reached, or
      // breaks down when it wants to say so.
      if (outcome.messages.find("CPLCreateMutexInternal") != std::string::npos) continue;
      if (outcome.exit_code == -1 && outcome.messages.find("libgdal") != std::string::npos) continue;
      EXPECT_EQ(outcome.exit_code, 1) << outcome.messages;
      ASSERT_EQ(outcome.failures().size(), 1U) << outcome.messages;
      EXPECT_NE(outcome.failures()[0].find("out of memory"), std::string::npos) << outcome.messages;
    }
  }
  EXPECT_GT(without, 2);
  EXPECT_GT(with, 0);
}

}  // namespace
}  // namespace edgeslam
