#include "drivers/lcm/status_message.h"

#include <gtest/gtest.h>

#include <limits>

#include "edgeslam/state_t.hpp"
#include "unit/dataset/temporary_folder.h"
#include "unit/lcm/made_frames.h"

namespace edgeslam {
namespace {

TEST(FrameStatistics, RatesAndPercentilesAreOfTheTimeBetweenTwoStatuses) {
  FrameStatistics statistics;
  statistics.take(1000);
  for (int i = 0; i < 200; ++i) {
    FrameResult frame = i % 4 ? measuredFrame(i, Pose()) : frameWithoutPose(i, TrackingState::lost, "dark");
    frame.latency_ms = 200 - i;  // 1 to 200
    statistics.add(frame);
  }
  const FrameFigures figures = statistics.take(1000 + 4000000000);
  EXPECT_DOUBLE_EQ(figures.frames_per_second, 50);
  EXPECT_DOUBLE_EQ(figures.poses_per_second, 37.5);
  EXPECT_EQ(figures.latency_p50_ms, 100);
  EXPECT_EQ(figures.latency_p99_ms, 198);
  const FrameFigures none = statistics.take(2000 + 4000000000);
  EXPECT_EQ(none.frames_per_second, 0);
  EXPECT_EQ(none.latency_p50_ms, -1);
}

TEST(FrameStatistics, TheLatestFramesStateIsKept) {
  FrameStatistics statistics;
  EXPECT_EQ(statistics.take(0).frames_per_second, -1) << "no time has gone by";
  statistics.add(frameWithoutPose(0, TrackingState::lost, "dark"));
  EXPECT_EQ(statistics.take(1).reason, "dark");
  EXPECT_EQ(statistics.take(2).state, TrackingState::lost);
}

TEST(FrameStatistics, IsBoundedWhereNobodyAsks) {
  FrameStatistics statistics;
  FrameResult frame = measuredFrame(0, Pose());
  for (int i = 0; i < 20000; ++i) {
    frame.latency_ms = i;
    statistics.add(frame);
  }
  EXPECT_LT(statistics.take(1).latency_p99_ms, 10000) << "the first 10000 are kept";
}

TEST(StatusMessage, TellsWhatItIsGivenAndNoNaN) {
  PublisherStatus status;
  status.version = "1.2.3";
  status.loops = 3;
  status.recording = true;
  FrameFigures figures;
  figures.latency_p99_ms = std::numeric_limits<double>::quiet_NaN();
  figures.state = TrackingState::relocalised;
  const status_t message = statusMessage(status, figures, {10, 2, 1, 4}, {12345, 51.5}, 6, 99);
  EXPECT_EQ(message.sequence, 6);
  EXPECT_EQ(message.utime, 99);
  EXPECT_EQ(message.version, "1.2.3");
  EXPECT_EQ(message.state, state_t::RELOCALISED);
  EXPECT_EQ(message.loops, 3);
  EXPECT_EQ(message.keyframes, -1) << "not known";
  EXPECT_TRUE(message.recording);
  EXPECT_EQ(message.messages_sent, 10);
  EXPECT_EQ(message.messages_not_sent, 2);
  EXPECT_EQ(message.commands_ignored, 4);
  EXPECT_EQ(message.memory_bytes, 12345);
  EXPECT_EQ(message.temperature_c, 51.5);
  EXPECT_EQ(message.latency_p99_ms, -1);
  EXPECT_LT(message.getEncodedSize(), 1300);
}

TEST(SystemFigures, MemoryAndTheWarmestZone) {
  const TemporaryFolder folder;
  folder.write("class/thermal/thermal_zone0/temp", "41000\n");
  folder.write("class/thermal/thermal_zone1/temp", "63500\n");
  folder.write("class/thermal/thermal_zone2/temp", "hot\n");
  folder.write("class/thermal/cooling_device0/temp", "99000\n");
  const SystemFigures figures = systemFigures(folder.path());
  EXPECT_EQ(figures.temperature_c, 63.5);
  EXPECT_GT(figures.memory_bytes, 1 << 20);
  EXPECT_EQ(systemFigures(folder.path("none")).temperature_c, -1);
}

}  // namespace
}  // namespace edgeslam
