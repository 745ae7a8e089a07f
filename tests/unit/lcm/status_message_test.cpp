#include "drivers/lcm/status_message.h"

#include <gtest/gtest.h>

#include <limits>

#include "edgeslam/state_t.hpp"
#include "unit/files/temporary_folder.h"
#include "unit/lcm/made_frames.h"

namespace edgeslam {
namespace {

// As the kernel puts it elsewhere.
std::int64_t residentMemory_kb() {
  std::ifstream file("/proc/self/status");
  std::int64_t kilobytes = 0;
  for (std::string word; file >> word;) {
    if (word == "VmRSS:") file >> kilobytes;
  }
  return kilobytes;
}

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

TEST(StatusMessage, TellsWhatItIsGiven) {
  const PublisherStatus status{1, "1.2.3", 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 20, true, "", "no ground"};
  const FrameFigures figures{TrackingState::relocalised, "found", 30.5, 29.5, 15, 25};
  const status_t message = statusMessage(status, figures, {13, 14, 15, 16}, {17, 51.5}, 18, 19);
  EXPECT_EQ(message.utime, 19);
  EXPECT_EQ(message.sequence, 18);
  EXPECT_EQ(message.uptime_ms, 1);
  EXPECT_EQ(message.state, state_t::RELOCALISED);
  EXPECT_EQ(message.reason, "found");
  EXPECT_EQ(message.version, "1.2.3");
  EXPECT_EQ(message.scale_reason, "no ground");
  EXPECT_EQ(message.frames_per_second, 30.5);
  EXPECT_EQ(message.poses_per_second, 29.5);
  EXPECT_EQ(message.latency_p50_ms, 15);
  EXPECT_EQ(message.latency_p99_ms, 25);
  EXPECT_EQ(message.frames_captured, 2);
  EXPECT_EQ(message.frames_dropped, 3);
  EXPECT_EQ(message.frames_unreadable, 4);
  EXPECT_EQ(message.results_not_published, 5);
  EXPECT_EQ(message.recoveries, 6);
  EXPECT_EQ(message.relocalisations, 7);
  EXPECT_EQ(message.loops, 8);
  EXPECT_EQ(message.mapping_queue, 9);
  EXPECT_EQ(message.publishing_queue, 10);
  EXPECT_EQ(message.keyframes, 11);
  EXPECT_EQ(message.points, 12);
  EXPECT_EQ(message.worlds, 20);
  EXPECT_TRUE(message.recording);
  EXPECT_EQ(message.messages_sent, 13);
  EXPECT_EQ(message.messages_not_sent, 14);
  EXPECT_EQ(message.commands_ignored, 16);
  EXPECT_EQ(message.memory_bytes, 17);
  EXPECT_EQ(message.temperature_c, 51.5);
}

TEST(StatusMessage, WhatIsNotKnownIsMinusOneAndNeverNaN) {
  FrameFigures figures;
  figures.latency_p99_ms = std::numeric_limits<double>::quiet_NaN();
  figures.reason = std::string(1000, 'x');
  const status_t message = statusMessage({}, figures, {}, {}, 0, 0);
  EXPECT_EQ(message.keyframes, -1);
  EXPECT_EQ(message.frames_per_second, -1);
  EXPECT_EQ(message.latency_p99_ms, -1);
  EXPECT_EQ(message.memory_bytes, -1);
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
  EXPECT_GT(figures.memory_bytes, residentMemory_kb() * 1000 / 2);
  EXPECT_LT(figures.memory_bytes, residentMemory_kb() * 1000 * 2);
  EXPECT_EQ(systemFigures(folder.path("none")).temperature_c, -1);
}

TEST(StatusMessage, WithoutACameraTheStateIsLostWithTheReason) {
  PublisherStatus status;
  status.camera_problem = "/dev/video0: unplugged";
  FrameFigures figures;
  figures.state = TrackingState::tracking;
  const status_t message = statusMessage(status, figures, {}, {}, 0, 0);
  EXPECT_EQ(message.state, state_t::LOST);
  EXPECT_EQ(message.reason, "/dev/video0: unplugged");
}

}  // namespace
}  // namespace edgeslam
