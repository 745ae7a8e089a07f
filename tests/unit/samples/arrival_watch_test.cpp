#include "samples/arrival_watch.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

constexpr std::int64_t ms = 1'000'000, second = 1000 * ms, start = 50 * second;

// Five seconds of samples, so much behind, and of 30 frames each second that come 10 ms after they were taken.
std::string problemWith(const ArrivalNeeds& needs, int interval_ms, int late_ms, std::int64_t clock_ns = 0) {
  ArrivalWatch watch(needs);
  std::int64_t sample_ns = start;
  for (std::int64_t frame_ns = start; frame_ns < start + 5 * second; frame_ns += 33 * ms) {
    for (; sample_ns + late_ms * ms <= frame_ns + 10 * ms; sample_ns += interval_ms * ms) {
      watch.add(sample_ns + clock_ns);
    }
    watch.addFrame(frame_ns);
  }
  EXPECT_EQ(watch.silence(), "");
  EXPECT_TRUE(watch.hasSeenEnough());
  return watch.timingProblem();
}

TEST(ArrivalWatch, AsksForWhatTheSensorNeeds) {
  const ArrivalNeeds strict{0, 0.02, 50, 100}, easy{0, 0.1, 15, 20};
  EXPECT_EQ(problemWith(strict, 10, 3), "");
  EXPECT_EQ(problemWith(strict, 30, 0), "it comes 33 times a second; 100 are needed");
  EXPECT_EQ(problemWith(easy, 30, 0), "");
  EXPECT_NE(problemWith(strict, 10, 60).find("ms late"), std::string::npos);
  EXPECT_EQ(problemWith(easy, 10, 60), "");
}

TEST(ArrivalWatch, AnotherClockIsToldUnlessItsOffsetIsKnown) {
  ArrivalNeeds needs;
  EXPECT_NE(problemWith(needs, 10, 3, 20 * second).find("CLOCK_MONOTONIC"), std::string::npos);
  needs.offset_ns = 20 * second;
  EXPECT_EQ(problemWith(needs, 10, 3, 20 * second), "");
}

TEST(ArrivalWatch, SilenceIsToldByTheFrames) {
  ArrivalWatch watch({});
  EXPECT_EQ(watch.silence(), "");
  watch.addFrame(start);
  watch.addFrame(start + 3 * second);
  EXPECT_EQ(watch.silence(), "nothing has come from it for 3 s");
  watch.add(start + 3 * second);
  watch.addFrame(start + 3 * second + 30 * ms);
  EXPECT_EQ(watch.silence(), "");
  EXPECT_FALSE(watch.hasSeenEnough());
  EXPECT_EQ(watch.timingProblem(), "");
  watch.addFrame(start + 5 * second);
  EXPECT_EQ(watch.silence(), "nothing comes from it any more, for 2 s");
}

}  // namespace
}  // namespace edgeslam
