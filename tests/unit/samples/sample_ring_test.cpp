#include "samples/sample_ring.h"

#include <gtest/gtest.h>

#include "unit/samples/timed_sample.h"

namespace edgeslam {
namespace {

bool add(SampleRing<TimedSample>& ring, std::int64_t time) {
  if (!ring.isNext(time)) return false;
  ring.push({time});
  return true;
}

TEST(SampleRing, KeepsTheLatestInOrder) {
  SampleRing<TimedSample> ring(7);
  EXPECT_TRUE(ring.empty());
  EXPECT_EQ(ring.firstAfter(0), 0U);
  for (std::int64_t time = 0; time < 100; ++time) {
    EXPECT_TRUE(add(ring, time));
    EXPECT_EQ(ring.size(), static_cast<std::size_t>(std::min<std::int64_t>(time + 1, 7)));
    EXPECT_EQ(ring.last().time_ns, time);
    EXPECT_EQ(ring.at(0).time_ns, std::max<std::int64_t>(0, time - 6));
  }
  ring.popFirst();
  EXPECT_EQ(ring.at(0).time_ns, 94);
  EXPECT_EQ(ring.firstAfter(0), 0U);
  EXPECT_EQ(ring.firstAfter(94), 1U);
  EXPECT_EQ(ring.firstAfter(99), ring.size());
}

TEST(SampleRing, OnlyAClockThatWasSetBackBeginsAnew) {
  SampleRing<TimedSample> ring(100);
  for (std::int64_t time = 1000; time < 1050; ++time) add(ring, time);
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(add(ring, 1049)) << "the same again";
  for (int i = 0; i < 19; ++i) EXPECT_FALSE(add(ring, i));
  EXPECT_TRUE(add(ring, 1050));
  for (int i = 0; i < 19; ++i) EXPECT_FALSE(add(ring, i));
  EXPECT_EQ(ring.size(), 51U);
  EXPECT_TRUE(add(ring, 19)) << "twenty in a row";
  EXPECT_EQ(ring.size(), 1U);
  EXPECT_TRUE(add(ring, 20));
}

}  // namespace
}  // namespace edgeslam
