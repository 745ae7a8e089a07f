#include "pipeline/duration_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <thread>
#include <vector>

namespace edgeslam {
namespace {

TEST(DurationStatistics, NothingAddedIsNothing) {
  const DurationSummary summary = DurationStatistics().summary("waiting");
  EXPECT_EQ(summary.name, "waiting");
  EXPECT_EQ(summary.count, 0);
  EXPECT_EQ(summary.max, 0);
}

TEST(DurationStatistics, QuantilesAreWithinFivePercent) {
  std::mt19937 random(4);
  std::lognormal_distribution<double> durations_us(8, 1.5);
  DurationStatistics statistics;
  std::vector<double> all_ms;
  double sum = 0;
  for (int i = 0; i < 10000; ++i) {
    const auto duration_ns = static_cast<std::int64_t>(1e3 * durations_us(random));
    statistics.add(duration_ns);
    all_ms.push_back(1e-6 * static_cast<double>(duration_ns));
    sum += all_ms.back();
  }
  std::sort(all_ms.begin(), all_ms.end());
  const DurationSummary summary = statistics.summary("");
  EXPECT_EQ(summary.count, 10000);
  EXPECT_NEAR(summary.mean, sum / 10000, 1e-6 * sum);
  EXPECT_NEAR(summary.median, all_ms[4999], 0.05 * all_ms[4999]);
  EXPECT_NEAR(summary.percentile_99, all_ms[9899], 0.05 * all_ms[9899]);
  EXPECT_DOUBLE_EQ(summary.max, all_ms.back());
}

TEST(DurationStatistics, WhatIsOutsideTheTableStillCounts) {
  DurationStatistics statistics;
  for (const std::int64_t duration_ns : {std::int64_t{-5}, std::int64_t{0}, std::int64_t{1} << 60}) {
    statistics.add(duration_ns);
  }
  const DurationSummary summary = statistics.summary("");
  EXPECT_EQ(summary.count, 3);
  EXPECT_GT(summary.max, 1e9);
  EXPECT_LE(summary.percentile_99, summary.max);
}

TEST(DurationStatistics, CanBeReadWhileItGrows) {
  DurationStatistics statistics;
  std::thread adding([&] {
    for (int i = 1; i <= 100000; ++i) statistics.add(i);
  });
  std::int64_t before = 0;
  while (before < 100000) {
    const std::int64_t count = statistics.summary("").count;
    ASSERT_GE(count, before);
    before = count;
  }
  adding.join();
}

}  // namespace
}  // namespace edgeslam
