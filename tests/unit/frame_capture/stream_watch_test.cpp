#include "drivers/frame_capture/stream_watch.h"

#include <gtest/gtest.h>

#include <vector>

#include "unit/frame_capture/stream_times.h"

namespace edgeslam {
namespace {

TEST(StreamWatch, AFrozenStreamIsNoticedWithinHalfASecondFromTenFramesASecondOn) {
  for (const std::int64_t frame_interval : {std::int64_t{0}, 8 * ms, 16 * ms, 33 * ms, 80 * ms, 100 * ms}) {
    StreamWatch watch;
    watch.opened(0, frame_interval);
    watch.gotFrame(1000 * ms);
    EXPECT_LE(watch.frozenAt() - 1000 * ms, 500 * ms) << frame_interval;
    EXPECT_GE(watch.frozenAt() - 1000 * ms, 3 * frame_interval) << frame_interval;
  }
}

TEST(StreamWatch, ASlowCameraIsNotTakenForFrozen) {
  StreamWatch watch;
  watch.opened(0, 1000 * ms);
  watch.gotFrame(1000 * ms);
  EXPECT_GT(watch.frozenAt(), 3000 * ms);
}

TEST(StreamWatch, ACameraMayTakeLongerForItsFirstFrame) {
  StreamWatch watch;
  watch.opened(5000 * ms, stream_interval_ns);
  EXPECT_GE(watch.frozenAt(), 6500 * ms);
  watch.gotDamagedFrame(5500 * ms);
  EXPECT_GE(watch.frozenAt(), 6500 * ms);
}

TEST(StreamWatch, DamagedFramesAreASignOfLifeForAWhile) {
  const WatchPolicy policy;
  StreamWatch watch(policy);
  watch.opened(0, stream_interval_ns);
  watch.gotFrame(100 * ms);
  std::int64_t now = 100 * ms;
  while (now < watch.frozenAt()) {
    watch.gotDamagedFrame(now);
    now += stream_interval_ns;
  }
  EXPECT_GE(now - 100 * ms, policy.only_damaged_ns);
  EXPECT_LE(now - 100 * ms, policy.only_damaged_ns + stream_interval_ns);
}

// The waits between attempts that all fail at once.
std::vector<std::int64_t> waits(StreamWatch& watch, std::int64_t now, int attempts) {
  std::vector<std::int64_t> found;
  for (int i = 0; i < attempts; ++i) {
    watch.failed(now);
    EXPECT_FALSE(watch.isOpen());
    found.push_back(watch.tryAt() - now);
    now = watch.tryAt();
  }
  return found;
}

TEST(StreamWatch, WaitsDoubleUpToTheLongest) {
  StreamWatch watch;
  EXPECT_EQ(watch.tryAt(), 0);
  const std::vector<std::int64_t> found = waits(watch, 77, 9);
  for (std::size_t i = 1; i < found.size(); ++i) EXPECT_EQ(found[i], std::min(2 * found[i - 1], 5000 * ms));
  EXPECT_EQ(found.front(), 100 * ms);
  EXPECT_EQ(found.back(), 5000 * ms);
}

TEST(StreamWatch, ACameraThatKeepsFallingOutIsNotOpenedEverFaster) {
  StreamWatch watch;
  std::int64_t now = 0, last_wait = 0;
  for (int i = 0; i < 5; ++i) {
    watch.opened(now, stream_interval_ns);
    watch.gotFrame(now += stream_interval_ns);
    watch.failed(now += stream_interval_ns);
    EXPECT_GT(watch.tryAt() - now, last_wait);
    last_wait = watch.tryAt() - now;
    now = watch.tryAt();
  }
}

TEST(StreamWatch, AfterAHealthyTimeTheWaitsBeginAnew) {
  StreamWatch watch;
  waits(watch, 0, 6);
  watch.opened(0, stream_interval_ns);
  for (std::int64_t now = 0; now < 4000 * ms; now += stream_interval_ns) watch.gotFrame(now);
  watch.failed(4000 * ms);
  EXPECT_EQ(watch.tryAt() - 4000 * ms, 100 * ms);
}

}  // namespace
}  // namespace edgeslam
