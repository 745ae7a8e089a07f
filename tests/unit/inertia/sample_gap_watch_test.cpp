#include "inertia/sample_gap_watch.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

constexpr std::int64_t ms = 1'000'000, second = 1000 * ms, start = 50 * second;

// Every 5 ms, from one time up to before another.
void give(std::int64_t from_ns, std::int64_t until_ns, SampleGapWatch& watch) {
  for (std::int64_t time_ns = from_ns; time_ns < until_ns; time_ns += 5 * ms) watch.add(time_ns);
}

TEST(SampleGapWatch, NothingIsMissingWhereSamplesComeAsOftenAsTheyNeed) {
  SampleGapWatch watch;
  EXPECT_EQ(watch.problem(), "");
  give(start, start + second, watch);
  watch.add(start + second + 50 * ms);
  give(start + second + 105 * ms, start + 3 * second, watch);
  EXPECT_EQ(watch.problem(), "");
}

TEST(SampleGapWatch, GapsAreToldWithHowOftenAndHowLong) {
  SampleGapWatch watch;
  give(start, start + second, watch);
  give(start + second + 95 * ms, start + 2 * second, watch);
  EXPECT_EQ(
      watch.problem(),
      "samples are missing: 1 gap in the last 10 s, 0.10 s in all, the longest 0.10 s; there the camera is alone");
  give(start + 2 * second + 395 * ms, start + 4 * second, watch);
  EXPECT_EQ(
      watch.problem(),
      "samples are missing: 2 gaps in the last 10 s, 0.50 s in all, the longest 0.40 s; there the camera is alone");
}

TEST(SampleGapWatch, ThatAreOldAreForgotten) {
  SampleGapWatch watch;
  give(start, start + second, watch);
  give(start + 2 * second, start + 11 * second, watch);
  EXPECT_NE(watch.problem(), "");
  give(start + 11 * second, start + 13 * second, watch);
  EXPECT_EQ(watch.problem(), "");
}

TEST(SampleGapWatch, AClockThatIsSetBackMakesNone) {
  SampleGapWatch watch;
  give(start, start + second, watch);
  give(start - 20 * second, start - 18 * second, watch);
  EXPECT_EQ(watch.problem(), "");
}

TEST(SampleGapWatch, OfARecordingAllAreTold) {
  std::vector<InertialSample> samples;
  for (int i = 0; i < 8000; ++i) {
    InertialSample sample;
    sample.time_ns = start + i * 5 * ms;
    if (i % 2000 < 1980) samples.push_back(sample);
  }
  EXPECT_EQ(sampleGapProblem(samples),
            "samples are missing: 3 gaps, 0.32 s in all, the longest 0.11 s; there the camera is alone");
  samples.resize(1980);
  EXPECT_EQ(sampleGapProblem(samples), "");
  EXPECT_EQ(sampleGapProblem({}), "");
}

}  // namespace
}  // namespace edgeslam
