// How long the robot waits for the first frame after the program's start.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>

#include "system/daemon/daemon_fixture.h"

namespace edgeslam {
namespace {

constexpr double longest_start_s = 0.5;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double slower = 20;
#else
constexpr double slower = 1;
#endif

struct Start {
  double wall_s = 0;       // from the program's start to the first frame's state, as the robot hears it
  double processor_s = 0;  // of all threads
};

// A machine with other work has less of a processor for it, but the work is the same: processor time is held to the
// bound, the best of some starts, and the clock's time is told.
TEST_F(DaemonTest, TheFirstFrameIsProcessedWithinHalfASecondOfTheStart) {
  std::vector<Start> starts;
  for (int i = 0; i < 5; ++i) {
    const std::size_t heard_before = robot_->heard().states.size();
    const auto begin = std::chrono::steady_clock::now();
    const auto daemon = startOn(parlour_);
    Start start;
    while (robot_->heard().states.size() == heard_before) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      start.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      ASSERT_LT(start.wall_s, 60) << daemon->said();
    }
    start.processor_s = daemon->processorTime();
    ASSERT_GT(start.processor_s, 0);
    std::printf("first frame processed %.3f s after the start, %.3f s of processor time\n", start.wall_s,
                start.processor_s);
    starts.push_back(start);
    daemon->end(SIGKILL);
    // Nothing of this start is taken for the next one's.
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  const auto fastest = std::min_element(starts.begin(), starts.end(),
                                        [](const Start& a, const Start& b) { return a.processor_s < b.processor_s; });
  EXPECT_LT(fastest->processor_s, slower * longest_start_s);
}

}  // namespace
}  // namespace edgeslam
