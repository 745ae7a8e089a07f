#include "samples/sample_feed.h"

#include <gtest/gtest.h>

#include "unit/samples/timed_sample.h"

namespace edgeslam {
namespace {

TEST(SampleFeed, GivesWhatWasMeasuredUntilAFrameAndTheFirstAfterIt) {
  std::vector<TimedSample> samples;
  for (std::int64_t time_ns = 100; time_ns <= 1000; time_ns += 10) samples.push_back({time_ns});
  for (const std::int64_t offset_ns : {0, 5, -40}) {
    SampleFeed feed(samples, offset_ns);
    std::vector<std::int64_t> given;
    for (std::int64_t frame_ns = 0; frame_ns < 2000; frame_ns += 33) {
      feed.giveUntil(frame_ns, [&](const TimedSample& sample) { given.push_back(sample.time_ns); });
      ASSERT_FALSE(given.empty());
      const std::int64_t now = frame_ns + offset_ns;
      EXPECT_TRUE(given.back() >= now || given.size() == samples.size());
      EXPECT_TRUE(given.size() == 1 || given[given.size() - 2] < now);
    }
    ASSERT_EQ(given.size(), samples.size());
    for (std::size_t i = 0; i < given.size(); ++i) EXPECT_EQ(given[i], samples[i].time_ns);
  }
}

}  // namespace
}  // namespace edgeslam
