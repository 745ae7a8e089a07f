#include "wheels/wheel_watch.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

constexpr std::int64_t start_us = 50'000'000;

// Five seconds at half a metre a second, told each `interval_us`, with the positions in so many of a metre, and frames
// that come 10 ms after they were taken.
std::string problemWith(std::int64_t interval_us, std::int64_t late_us, double units_a_metre = 1) {
  WheelWatch watch;
  std::int64_t utime = start_us;
  for (std::int64_t frame_us = start_us; frame_us < start_us + 5'000'000; frame_us += 33'000) {
    for (; utime + late_us <= frame_us + 10'000; utime += interval_us) {
      const double x = units_a_metre * 0.5e-6 * static_cast<double>(utime - start_us);
      watch.add({utime, {Eigen::Quaterniond::Identity(), {x, 0, 0}}});
    }
    watch.addFrame(1000 * frame_us);
  }
  return watch.problem();
}

TEST(WheelWatch, NothingIsWrongWithGoodWheels) {
  EXPECT_EQ(WheelWatch().problem(), "");
  EXPECT_EQ(problemWith(20'000, 3000), "");
  EXPECT_EQ(problemWith(50'000, 3000), "");
}

TEST(WheelWatch, JumpsAndLatenessAndLowRatesAreTold) {
  EXPECT_NE(problemWith(20'000, 3000, 1000).find("is the position in metres?"), std::string::npos);
  EXPECT_NE(problemWith(20'000, 200'000).find("ms late"), std::string::npos);
  EXPECT_EQ(problemWith(60'000, 3000), "");
}

TEST(WheelWatch, SilenceIsTold) {
  WheelWatch watch;
  watch.addFrame(0);
  watch.addFrame(2'000'000'000);
  EXPECT_EQ(watch.problem(), "nothing has come from it for 2 s");
}

}  // namespace
}  // namespace edgeslam
