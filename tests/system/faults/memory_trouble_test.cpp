// The memory ends in mid-run: the program says so, and what was mapped is saved.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "map/saved_map.h"
#include "recording/open_frame_source.h"
#include "system/faults/faulty_daemon.h"

namespace edgeslam {
namespace {

class MemoryOfARun : public FaultyDaemon {
 protected:
  // It gets no more than it has.
  static void endMemoryOf(const BackgroundProcess& process) {
    const std::int64_t data = dataOf(process.id());
    ASSERT_GT(data, 0);
    const rlimit nothing_more{static_cast<rlim_t>(data), RLIM_INFINITY};
    ASSERT_EQ(prlimit(process.id(), RLIMIT_DATA, &nothing_more, nullptr), 0);
  }

 private:
  // [bytes] that the process can write to, of its own.
  static std::int64_t dataOf(pid_t process) {
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    std::string word;
    while (status >> word && word != "VmData:") continue;
    std::int64_t kilobytes = 0;
    status >> kilobytes;
    return kilobytes << 10;
  }
};

TEST_F(MemoryOfARun, WhereItEndsTheMapIsSavedAndTheRecordingWhole) {
  const auto daemon = startFaulty(FaultPlan(), {"--record", recordings_, "--map-out", map_});
  ASSERT_TRUE(isTracking()) << daemon->said();
  daemon->send(SIGHUP);
  ASSERT_TRUE(daemon->says("points saved to " + map_)) << daemon->said();
  ASSERT_TRUE(hasRecorded(recordings_, 30)) << daemon->said();
  const std::string saved = fileContent(map_);

  endMemoryOf(*daemon);
  EXPECT_EQ(daemon->exitCode(), 1) << daemon->said();
  EXPECT_EQ(daemon->times("edgeslam: out of memory"), 1) << daemon->said();
  EXPECT_EQ(daemon->times(" keyframes saved to " + map_), 1) << daemon->said();
  EXPECT_FALSE(fileContent(map_) == saved) << "it grew since";
  EXPECT_FALSE(loadMap(map_, *openFrameSource(source_)->camera()).points.empty());
  EXPECT_GE(readRecording(recordings_).frames.size(), 30U);
}

TEST_F(MemoryOfARun, WhereItEndsInAReplayTheMapIsSavedAndNoHalfResults) {
  for (const Options& how : {Options{}, Options{"--realtime", "--pace", "2"}}) {
    SCOPED_TRACE(how.size());
    std::filesystem::remove(map_);
    Options command{EDGESLAM_PROGRAM, "replay", source_, "--output", folder_.path("result"), "--map-out", map_};
    command.insert(command.end(), how.begin(), how.end());
    BackgroundProcess replay(command);
    ASSERT_TRUE(comesTrue([&] { return replay.processorTime() > 2; })) << replay.said();  // over a hundred frames
    endMemoryOf(replay);
    EXPECT_EQ(replay.exitCode(), 1) << replay.said();
    EXPECT_EQ(replay.times("edgeslam: out of memory"), 1) << replay.said();
    EXPECT_EQ(replay.times(" keyframes saved to " + map_ + ", as it was when memory ran out"), 1) << replay.said();
    EXPECT_FALSE(loadMap(map_, *openFrameSource(source_)->camera()).points.empty());
    EXPECT_FALSE(std::filesystem::exists(folder_.path("result")));
  }
}

}  // namespace
}  // namespace edgeslam
