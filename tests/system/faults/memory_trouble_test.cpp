// The daemon's memory ends in mid-run: it says so, and what it had saved is there.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "dataset/recording_source.h"
#include "dataset/saved_map.h"
#include "system/faults/faulty_daemon.h"

namespace edgeslam {
namespace {

class MemoryOfADaemon : public FaultyDaemon {};

TEST_F(MemoryOfADaemon, WhereItEndsCostsNothingThatWasSaved) {
  const auto daemon = startFaulty(FaultPlan(), {"--record", recordings_, "--map-out", map_});
  ASSERT_TRUE(isTracking()) << daemon->said();
  daemon->send(SIGHUP);
  ASSERT_TRUE(daemon->says("points saved to " + map_)) << daemon->said();
  const std::string saved = fileContent(map_);
  ASSERT_TRUE(goesOn(60)) << daemon->said();

  // Nothing more than it has now.
  const rlimit nothing_more{1 << 20, RLIM_INFINITY};
  ASSERT_EQ(prlimit(daemon->id(), RLIMIT_AS, &nothing_more, nullptr), 0);
  daemon->send(SIGHUP);
  EXPECT_TRUE(daemon->says("out of memory")) << daemon->said();
  daemon->send(SIGTERM);
  EXPECT_EQ(daemon->exitCode(), 1) << daemon->said();
  EXPECT_TRUE(fileContent(map_) == saved);
  EXPECT_FALSE(loadMap(map_, *openFrameSource(source_)->camera()).points.empty());
  EXPECT_GT(readRecording(recordings_).frames.size(), 30U);
  EXPECT_EQ(daemon->said().find("terminate called"), std::string::npos) << daemon->said();
}

}  // namespace
}  // namespace edgeslam
