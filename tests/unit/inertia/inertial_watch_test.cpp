#include "inertia/inertial_watch.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

constexpr std::int64_t ms = 1'000'000, second = 1000 * ms, start = 50 * second;

InertialSample atRest(std::int64_t time_ns) { return {time_ns, {0.01, 0, 0}, {0, 0, 9.8}}; }

struct Given {
  int interval_ms = 5, late_ms = 3;  // of samples; a frame comes 10 ms after it was taken
  double force_factor = 1, rate_factor = 1;
  std::int64_t clock_ns = 0;  // of the unit, from the camera's
};

// Some seconds of samples and of 30 frames each second, as they come.
void give(const Given& given, std::int64_t from_ns, std::int64_t until_ns, InertialWatch& watch) {
  std::int64_t sample_ns = from_ns;
  for (std::int64_t frame_ns = from_ns; frame_ns < until_ns; frame_ns += 33 * ms) {
    for (; sample_ns + given.late_ms * ms <= frame_ns + 10 * ms; sample_ns += given.interval_ms * ms) {
      InertialSample sample = atRest(sample_ns + given.clock_ns);
      sample.force *= given.force_factor;
      sample.rate *= given.rate_factor;
      watch.add(sample);
    }
    watch.addFrame(frame_ns);
  }
}

std::string problemWith(const Given& given, std::int64_t offset_ns = 0) {
  InertialWatch watch(offset_ns);
  give(given, start, start + 5 * second, watch);
  return watch.problem();
}

TEST(InertialWatch, NothingIsWrongWithAGoodUnit) {
  EXPECT_EQ(problemWith({}), "");
  EXPECT_EQ(problemWith({1, 20}), "");
  EXPECT_EQ(problemWith({10, 0}), "");
  EXPECT_EQ(InertialWatch(0).problem(), "");
}

TEST(InertialWatch, SilenceIsTold) {
  InertialWatch watch(0);
  watch.addFrame(start);
  watch.addFrame(start + second / 2);
  EXPECT_EQ(watch.problem(), "");
  watch.addFrame(start + 3 * second);
  EXPECT_EQ(watch.problem(), "nothing has come from it for 3 s");
  give({}, start + 3 * second, start + 5 * second, watch);
  EXPECT_EQ(watch.problem(), "");
  watch.addFrame(start + 9 * second);
  EXPECT_EQ(watch.problem(), "nothing comes from it any more, for 4 s");
}

TEST(InertialWatch, OtherUnitsAreTold) {
  EXPECT_NE(problemWith({5, 3, 1 / 9.8}).find("multiples of g"), std::string::npos);
  EXPECT_NE(problemWith({5, 3, 1, 3000}).find("degrees"), std::string::npos);
}

TEST(InertialWatch, AnotherClockIsToldUnlessItsOffsetIsKnown) {
  EXPECT_NE(problemWith({5, 3, 1, 1, -3000 * second}).find("CLOCK_MONOTONIC"), std::string::npos);
  EXPECT_EQ(problemWith({5, 3, 1, 1, -3000 * second}, -3000 * second), "");
}

TEST(InertialWatch, LateAndRareSamplesAreTold) {
  EXPECT_NE(problemWith({5, 80}).find("ms late"), std::string::npos);
  EXPECT_NE(problemWith({40, 3}).find("25 times a second"), std::string::npos);
}

TEST(InertialWatch, GapsAreTold) {
  InertialWatch watch(0);
  give({}, start, start + 2 * second, watch);
  EXPECT_EQ(watch.problem(), "");
  give({}, start + 2 * second + 400 * ms, start + 5 * second, watch);
  EXPECT_NE(watch.problem().find("samples are missing: 1 gap in the last 10 s"), std::string::npos) << watch.problem();
}

}  // namespace
}  // namespace edgeslam
