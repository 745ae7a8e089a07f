#include "inertia/samples_since.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

TEST(SamplesSince, AreThoseAtTheTimeAndAfterIt) {
  std::vector<InertialSample> samples(4);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].time_ns = 10 * static_cast<std::int64_t>(i);
  EXPECT_EQ(samplesSince(samples, -5).size(), 4U);
  ASSERT_EQ(samplesSince(samples, 10).size(), 3U);
  EXPECT_EQ(samplesSince(samples, 10).front().time_ns, 10);
  EXPECT_EQ(samplesSince(samples, 11).front().time_ns, 20);
  EXPECT_TRUE(samplesSince(samples, 31).empty());
  EXPECT_TRUE(samplesSince({}, 0).empty());
}

}  // namespace
}  // namespace edgeslam
