#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "drivers/frame_capture/exposure_middle.h"
#include "drivers/frame_capture/sequence_counter.h"
#include "unit/frame_capture/stream_times.h"

namespace edgeslam {
namespace {

struct Counted {
  std::vector<std::int64_t> sequence, lost;
};

Counted count(const std::vector<std::uint32_t>& numbers) {
  SequenceCounter counter;
  Counted counted;
  for (const std::uint32_t number : numbers) {
    const SequenceCounter::Numbered frame = counter.add(number);
    counted.sequence.push_back(frame.sequence);
    counted.lost.push_back(frame.lost_before);
  }
  return counted;
}

using Numbers = std::vector<std::int64_t>;

TEST(SequenceCounter, GapsAreCounted) {
  const Counted counted = count({7, 8, 11, 12});
  EXPECT_EQ(counted.sequence, (Numbers{0, 1, 4, 5}));
  EXPECT_EQ(counted.lost, (Numbers{0, 0, 2, 0}));
}

TEST(SequenceCounter, GoesOnWhereTheDriversNumberWraps) {
  const Counted counted = count({0xFFFFFFFD, 0xFFFFFFFE, 1, 2});
  EXPECT_EQ(counted.sequence, (Numbers{0, 1, 4, 5}));
  EXPECT_EQ(counted.lost, (Numbers{0, 0, 2, 0}));
}

TEST(SequenceCounter, ADriverThatDoesNotCountOrBeginsAnewLosesNothing) {
  EXPECT_EQ(count({0, 0, 0}).sequence, (Numbers{0, 1, 2}));
  EXPECT_EQ(count({0, 0, 0}).lost, (Numbers{0, 0, 0}));
  EXPECT_EQ(count({900, 901, 0, 1, 3}).sequence, (Numbers{0, 1, 2, 3, 5}));
  EXPECT_EQ(count({900, 901, 0, 1, 3}).lost, (Numbers{0, 0, 0, 0, 1}));
}

constexpr std::int64_t arrival = 50'000 * ms;

TEST(ExposureMiddle, IsBetweenStartAndEndOfTheExposure) {
  const FrameTime from_start =
      middleOfExposure(DriverStamp{arrival - 30 * ms, TimeMeaning::exposure_start}, 8 * ms, 0, arrival);
  EXPECT_EQ(from_start.time_ns, arrival - 26 * ms);
  EXPECT_EQ(from_start.meaning, TimeMeaning::exposure_middle);
  const FrameTime from_end =
      middleOfExposure(DriverStamp{arrival - 22 * ms, TimeMeaning::exposure_end}, 8 * ms, 0, arrival);
  EXPECT_EQ(from_end.time_ns, from_start.time_ns);
  EXPECT_EQ(from_end.meaning, TimeMeaning::exposure_middle);
}

TEST(ExposureMiddle, WithoutTheExposureTimeTheStampStaysWhatItIs) {
  for (const std::int64_t unknown : {std::int64_t{0}, std::int64_t{-5}, 100'000 * ms}) {
    for (const TimeMeaning meaning : {TimeMeaning::exposure_start, TimeMeaning::exposure_end}) {
      const FrameTime time = middleOfExposure(DriverStamp{arrival - 30 * ms, meaning}, unknown, 0, arrival);
      EXPECT_EQ(time.time_ns, arrival - 30 * ms);
      EXPECT_EQ(time.meaning, meaning);
    }
  }
}

TEST(ExposureMiddle, OfARollingShutterIsThatOfTheMiddleRow) {
  for (const double readout_s :
       {0.024, -0.024}) {  // from below, the middle row is as far from the first as from the last
    // The first row is exposed from 40 ms before the arrival, the last one's exposure ends 8 + 24 ms later.
    const FrameTime from_start =
        middleOfExposure(DriverStamp{arrival - 40 * ms, TimeMeaning::exposure_start}, 8 * ms, readout_s, arrival);
    EXPECT_EQ(from_start.time_ns, arrival - 40 * ms + 12 * ms + 4 * ms);
    EXPECT_EQ(from_start.meaning, TimeMeaning::exposure_middle);
    const FrameTime from_end =
        middleOfExposure(DriverStamp{arrival - 8 * ms, TimeMeaning::exposure_end}, 8 * ms, readout_s, arrival);
    EXPECT_EQ(from_end.time_ns, from_start.time_ns);
    EXPECT_EQ(from_end.meaning, TimeMeaning::exposure_middle);
  }
}

TEST(ExposureMiddle, WithoutTheExposureTimeTheMiddleRowsStartOrEndIsKnown) {
  for (const TimeMeaning meaning : {TimeMeaning::exposure_start, TimeMeaning::exposure_end}) {
    const FrameTime time = middleOfExposure(DriverStamp{arrival - 30 * ms, meaning}, 0, 0.02, arrival);
    EXPECT_EQ(time.time_ns, arrival - 30 * ms + (meaning == TimeMeaning::exposure_start ? 10 : -10) * ms);
    EXPECT_EQ(time.meaning, meaning);
  }
}

TEST(ExposureMiddle, AReadoutThatCannotBeShiftsNothing) {
  for (const double readout_s : {0.0, 0.3, -0.3, 1e300, std::nan(""), double{INFINITY}, -double{INFINITY}}) {
    const DriverStamp stamp{arrival - 30 * ms, TimeMeaning::exposure_start};
    EXPECT_EQ(middleOfExposure(stamp, 8 * ms, readout_s, arrival).time_ns, arrival - 26 * ms) << readout_s;
  }
  EXPECT_EQ(middleOfExposure(std::nullopt, 8 * ms, 0.02, arrival).time_ns, arrival);
}

// Another clock, none, or a wrapped one.
TEST(ExposureMiddle, AStampThatCannotBeIsNotBelieved) {
  for (const std::int64_t stamp :
       {std::int64_t{0}, arrival - 6000 * ms, arrival + 1000 * ms, INT64_MAX, INT64_MIN + 1}) {
    const FrameTime time = middleOfExposure(DriverStamp{stamp, TimeMeaning::exposure_start}, 8 * ms, 0, arrival);
    EXPECT_EQ(time.time_ns, arrival);
    EXPECT_EQ(time.meaning, TimeMeaning::arrival);
  }
  EXPECT_EQ(middleOfExposure(std::nullopt, 8 * ms, 0, arrival).meaning, TimeMeaning::arrival);
}

}  // namespace
}  // namespace edgeslam
