// The daemon's memory ends in mid-run: it says so, and what it had saved is there.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "map/saved_map.h"
#include "recording/open_frame_source.h"
#include "system/faults/faulty_daemon.h"

namespace edgeslam {
namespace {

class MemoryOfADaemon : public FaultyDaemon {
 protected:
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

TEST_F(MemoryOfADaemon, WhereItEndsCostsNothingThatWasSaved) {
  const auto daemon = startFaulty(FaultPlan(), {"--record", recordings_, "--map-out", map_});
  ASSERT_TRUE(isTracking()) << daemon->said();
  daemon->send(SIGHUP);
  ASSERT_TRUE(daemon->says("points saved to " + map_)) << daemon->said();
  ASSERT_TRUE(hasRecorded(recordings_, 30)) << daemon->said();
  const std::string saved = fileContent(map_);

  const std::int64_t data = dataOf(daemon->id());
  ASSERT_GT(data, 0);
  const rlimit nothing_more{static_cast<rlim_t>(data), RLIM_INFINITY};
  ASSERT_EQ(prlimit(daemon->id(), RLIMIT_DATA, &nothing_more, nullptr), 0);
  EXPECT_EQ(daemon->exitCode(), 1) << daemon->said();
  EXPECT_EQ(daemon->times("edgeslam: out of memory"), 1) << daemon->said();
  EXPECT_TRUE(fileContent(map_) == saved);
  EXPECT_FALSE(loadMap(map_, *openFrameSource(source_)->camera()).points.empty());
  EXPECT_GE(readRecording(recordings_).frames.size(), 30U);
}

}  // namespace
}  // namespace edgeslam
