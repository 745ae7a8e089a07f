#include "edgeslam/live_slam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "edgeslam/slam.h"
#include "unit/library/simulated_robot.h"

namespace edgeslam {
namespace {

TEST(LiveSlam, EveryFrameThatIsTakenGetsItsPoseInOrder) {
  const SimulatedRobot& robot = simulatedRobot();
  std::vector<PosedFrame> poses;
  std::atomic<std::size_t> received{0};
  LiveSlam slam(robot.configuration, [&](const PosedFrame& pose) {
    poses.push_back(pose);
    ++received;
  });
  for (int i = 0; i < robot.frame_count; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    slam.handOver(robot.image(i), robot.sequence.time(i));
    // Slow machines get the time that they need: this is not about frames that are passed over.
    for (int wait = 0; wait < 1000 && received.load() <= static_cast<std::size_t>(i); ++wait) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    // Mapping comes after the pose, and takes as long.
    std::this_thread::sleep_for(
        std::max<std::chrono::nanoseconds>(std::chrono::milliseconds(20), std::chrono::steady_clock::now() - begin));
  }
  EXPECT_THROW(slam.map(), InputError) << "mapping still works on it";
  slam.stop();
  slam.stop();
  EXPECT_THROW(slam.handOver(robot.image(0), robot.sequence.time(robot.frame_count)), InputError);
  ASSERT_EQ(poses.size(), static_cast<std::size_t>(robot.frame_count));
  for (int i = 0; i < robot.frame_count; ++i) {
    EXPECT_EQ(poses[static_cast<std::size_t>(i)].index, i);
    EXPECT_EQ(poses[static_cast<std::size_t>(i)].time_ns, robot.sequence.time(i));
    EXPECT_GE(poses[static_cast<std::size_t>(i)].latency_ms, 0);
  }
  EXPECT_TRUE(poses.back().isGood()) << poses.back().reason;
  EXPECT_EQ(slam.counters().processed, robot.frame_count);
  EXPECT_EQ(slam.counters().passed_over, 0);
  EXPECT_EQ(slam.map().size(), slam.counters().points);
  EXPECT_NO_THROW(slam.saveMap(robot.folder.path("live.map")));
}

TEST(LiveSlam, AFrozenMapIsNeededAndStaysAsItIs) {
  const SimulatedRobot& robot = simulatedRobot();
  const std::string map_file = robot.folder.path("live_kept.map"), after = robot.folder.path("live_after.map");
  {
    Slam slam(robot.configuration);
    for (int i = 0; i < robot.frame_count; ++i) slam.process(robot.image(i), robot.sequence.time(i));
    slam.finish();
    slam.saveMap(map_file);
  }
  const std::string frozen =
      robot.folder.write("live_frozen.yaml", fileContent(robot.configuration) + "map: {frozen: true}\n");
  EXPECT_THROW(LiveSlam(frozen, LiveSlam::PoseReceiver()), InputError);
  EXPECT_THROW(LiveSlam(frozen, robot.configuration, LiveSlam::PoseReceiver()), InputError) << "that is no map";
  std::atomic<int> good{0};
  std::atomic<std::size_t> received{0};
  LiveSlam slam(frozen, map_file, [&](const PosedFrame& pose) {
    good += pose.isGood() ? 1 : 0;
    ++received;
  });
  const std::size_t points = slam.counters().points;
  EXPECT_GT(points, 0U);
  for (int i = 0; i < robot.frame_count; ++i) {
    slam.handOver(robot.image(i), robot.sequence.time(i));
    for (int wait = 0; wait < 1000 && received.load() <= static_cast<std::size_t>(i); ++wait) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  slam.stop();
  EXPECT_GT(good.load(), 0);
  EXPECT_EQ(slam.counters().points, points);
  slam.saveMap(after);
  EXPECT_TRUE(fileContent(after) == fileContent(map_file));
}

TEST(LiveSlam, AFrameThatCannotBeIsRefused) {
  const SimulatedRobot& robot = simulatedRobot();
  LiveSlam slam(robot.configuration, {});
  GreyImage low = robot.image(0);
  low.height = 10;
  EXPECT_THROW(slam.handOver(low, 0), InputError);
  slam.handOver(robot.image(0), 5);
  EXPECT_THROW(slam.handOver(robot.image(1), 5), InputError);
  EXPECT_EQ(slam.counters().handed_over, 1);
}

TEST(LiveSlam, EndsWhenItIsDestroyed) {
  const SimulatedRobot& robot = simulatedRobot();
  LiveSlam slam(robot.configuration, {});
  for (int i = 0; i < 10; ++i) slam.handOver(robot.image(i), robot.sequence.time(i));
}

}  // namespace
}  // namespace edgeslam
