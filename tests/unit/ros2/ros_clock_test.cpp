#include "drivers/ros2/ros_clock.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

constexpr std::int64_t boot_us = 1'700'000'000'000'000;  // the time of day when CLOCK_MONOTONIC was 0
constexpr std::int64_t frame_us = 33'333;

TEST(RosClock, ALiveFrameHasTheTimeOfDayAtWhichItWasTaken) {
  RosClock clock;
  for (std::int64_t utime = 5'000'000; utime < 6'000'000; utime += frame_us) {
    const std::int64_t published = utime + 20'000 + utime % 7'000;
    EXPECT_EQ(clock.stamp_ns(utime, boot_us + published, published), 1000 * (boot_us + utime));
  }
}

TEST(RosClock, ClocksThatAreNotReadAtOnceChangeNothing) {
  RosClock clock;
  clock.stamp_ns(5'000'000, boot_us + 5'020'000, 5'020'000);
  EXPECT_EQ(clock.stamp_ns(5'100'000, boot_us + 5'150'000, 5'120'000), 1000 * (boot_us + 5'100'000))
      << "30 ms went by between the two";
  EXPECT_EQ(clock.stamp_ns(5'200'000, boot_us + 5'220'500, 5'220'000), 1000 * (boot_us + 5'200'000));
}

TEST(RosClock, ATimeOfDayThatIsSetAnewIsFollowed) {
  RosClock clock;
  clock.stamp_ns(5'000'000, boot_us + 5'020'000, 5'020'000);
  const std::int64_t step = 3'600'000'000;
  clock.stamp_ns(5'100'000, boot_us + step + 5'120'000, 5'120'000);
  EXPECT_EQ(clock.stamp_ns(5'200'000, boot_us + step + 5'220'000, 5'220'000), 1000 * (boot_us + step + 5'200'000));
}

TEST(RosClock, ARecordingGoesOnFromNow) {
  RosClock clock;
  const std::int64_t recorded = 1'403'636'579'000'000, now = boot_us + 777'000'000;
  EXPECT_EQ(clock.stamp_ns(recorded, now, 777'000'000), 1000 * now);
  EXPECT_EQ(clock.stamp_ns(recorded + frame_us, now + frame_us + 900, 777'000'000 + frame_us + 900),
            1000 * (now + frame_us))
      << "times between frames are the recording's";
}

TEST(RosClock, ARecordingThatBeginsAgainGoesOnFromNow) {
  RosClock clock;
  clock.stamp_ns(100'000'000'000, boot_us, 1'000'000);
  clock.stamp_ns(50'000'000'000, boot_us + 1000, 1'001'000);
  EXPECT_EQ(clock.stamp_ns(50'000'000'000 + frame_us, boot_us + 1000 + frame_us, 1'001'000 + frame_us),
            1000 * (boot_us + 1000 + frame_us));
}

}  // namespace
}  // namespace edgeslam
