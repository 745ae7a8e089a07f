#include "edgeslam/slam.h"

#include <gtest/gtest.h>

#include <cmath>

#include "configuration/configuration.h"
#include "pipeline/lockstep_run.h"
#include "unit/library/simulated_robot.h"

namespace edgeslam {
namespace {

std::vector<PosedFrame> runOver(Slam& slam, int frames) {
  std::vector<PosedFrame> poses;
  for (int i = 0; i < frames; ++i) {
    poses.push_back(slam.process(simulatedRobot().image(i), simulatedRobot().sequence.time(i)));
  }
  return poses;
}

TEST(Slam, GivesWhatTheProgramGivesToTheLastBit) {
  const SimulatedRobot& robot = simulatedRobot();
  Slam slam(robot.configuration);
  EXPECT_EQ(slam.width(), 320);
  EXPECT_EQ(slam.height(), 240);
  const Configuration configuration = readConfiguration(robot.configuration);
  LockstepRun run(*configuration.camera, configuration.settings, 0, 0);
  int measured = 0;
  for (int i = 0; i < robot.frame_count; ++i) {
    const std::int64_t time_ns = robot.sequence.time(i);
    const PosedFrame frame = slam.process(robot.image(i), time_ns);
    run.process(i, time_ns, robot.images[static_cast<std::size_t>(i)]);
    const FrameResult& expected = run.latest();
    ASSERT_EQ(frame.index, i);
    ASSERT_EQ(frame.time_ns, time_ns);
    ASSERT_EQ(frame.reason, expected.reason);
    ASSERT_EQ(frame.has_pose, expected.has_pose);
    ASSERT_EQ(frame.world, expected.has_pose ? std::max(0, expected.world) : -1);
    ASSERT_EQ(frame.isGood(), isGoodPose(expected.state));
    if (!frame.has_pose) continue;
    ++measured;
    ASSERT_EQ(frame.pose.position[2], expected.world_T_camera.translation.z());
    ASSERT_EQ(frame.pose.orientation[0], expected.world_T_camera.rotation.w());
    ASSERT_EQ(frame.covariance[3 * 6 + 1], expected.covariance(3, 1));
    ASSERT_GT(frame.covariance[0], 0);
  }
  EXPECT_GT(measured, 20);
  EXPECT_EQ(slam.map().size(), run.map().points.size());
  EXPECT_EQ(slam.keyframes().size(), run.map().keyframes.size());

  const std::vector<TimedCameraPose> trajectory = slam.finish();
  std::size_t with_final_pose = 0;
  for (const FrameRecord& frame : run.finish().frames) {
    if (!frame.has_final_pose) continue;
    ASSERT_LT(with_final_pose, trajectory.size());
    EXPECT_EQ(trajectory[with_final_pose].time_ns, frame.time_ns);
    EXPECT_EQ(trajectory[with_final_pose].world, std::max(0, frame.final_world));
    EXPECT_EQ(trajectory[with_final_pose++].pose.position[0], frame.final_world_T_camera.translation.x());
  }
  EXPECT_EQ(with_final_pose, trajectory.size());
  EXPECT_FALSE(slam.map().empty()) << "it can be had afterwards";
}

TEST(Slam, AFrameThatCannotBeIsRefusedAndChangesNothing) {
  const SimulatedRobot& robot = simulatedRobot();
  Slam slam(robot.configuration), undisturbed(robot.configuration);
  for (int i = 0; i < 20; ++i) {
    const std::int64_t time_ns = robot.sequence.time(i);
    GreyImage narrow = robot.image(i), empty = robot.image(i), short_rows = robot.image(i);
    narrow.width = 319;
    empty.pixels = nullptr;
    short_rows.bytes_per_row = 319;
    for (const GreyImage& image : {narrow, empty, short_rows}) EXPECT_THROW(slam.process(image, time_ns), InputError);
    const PosedFrame frame = slam.process(robot.image(i), time_ns);
    EXPECT_THROW(slam.process(robot.image(i), time_ns), InputError) << "the same time again";
    EXPECT_THROW(slam.skip(time_ns - 1, "late"), InputError);
    EXPECT_EQ(frame.index, i);
    EXPECT_EQ(frame.reason, undisturbed.process(robot.image(i), time_ns).reason);
  }
  slam.finish();
  EXPECT_THROW(slam.process(robot.image(20), robot.sequence.time(20)), InputError);
  EXPECT_THROW(slam.finish(), InputError);
}

TEST(Slam, ASavedMapIsGoneOnWith) {
  const SimulatedRobot& robot = simulatedRobot();
  const std::string map_file = robot.folder.path("library.map");
  {
    Slam slam(robot.configuration);
    EXPECT_THROW(slam.saveMap(map_file), InputError) << "there is none yet";
    runOver(slam, robot.frame_count);
    slam.saveMap(map_file);
    EXPECT_THROW(slam.goOnWith(map_file), InputError) << "not after the first frame";
  }
  Slam again(robot.configuration);
  again.goOnWith(map_file);
  const std::vector<PosedFrame> frames = runOver(again, robot.frame_count);
  EXPECT_EQ(frames.front().state, SlamState::lost) << "it is somewhere in the map";
  EXPECT_TRUE(frames.back().isGood()) << frames.back().reason;
  const std::vector<std::string> events = again.takeEvents();
  ASSERT_FALSE(events.empty());
  EXPECT_TRUE(again.takeEvents().empty()) << "told once";
  again.finish();
  EXPECT_TRUE(again.takeEvents().empty());
}

// Localisation only.
TEST(Slam, AFrozenMapIsNeededAndStaysAsItIs) {
  const SimulatedRobot& robot = simulatedRobot();
  const std::string map_file = robot.folder.path("kept.map"), after = robot.folder.path("after.map");
  {
    Slam slam(robot.configuration);
    runOver(slam, robot.frame_count);
    slam.saveMap(map_file);
  }
  const std::string frozen =
      robot.folder.write("frozen.yaml", fileContent(robot.configuration) + "map: {frozen: true}\n");
  Slam slam(frozen);
  EXPECT_THROW(slam.process(robot.image(0), robot.sequence.time(0)), InputError) << "there is no map";
  EXPECT_THROW(slam.skip(robot.sequence.time(0), "late"), InputError);
  slam.goOnWith(map_file);
  const std::size_t points = slam.map().size(), keyframes = slam.keyframes().size();
  const std::vector<PosedFrame> frames = runOver(slam, robot.frame_count);
  EXPECT_TRUE(frames.back().isGood()) << frames.back().reason;
  EXPECT_EQ(slam.map().size(), points);
  EXPECT_EQ(slam.keyframes().size(), keyframes);
  slam.finish();
  slam.saveMap(after);
  EXPECT_TRUE(fileContent(after) == fileContent(map_file));
}

TEST(Slam, WhatCannotBeUsedIsToldWithItsFile) {
  const TemporaryFolder folder;
  const std::string empty = folder.write("empty.yaml", "");
  try {
    Slam slam(empty);
    ADD_FAILURE() << "there is no calibration";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), empty + ": no calibration: give one (camera.calibration)");
  }
  EXPECT_THROW(Slam(folder.path("nowhere.yaml")), InputError);
  const std::string calibration =
      folder.write("camera.yaml", "width: 640\nheight: 480\nfx: 500\nfy: 500\ncx: 320\ncy: 240\n");
  EXPECT_EQ(Slam(calibration, empty).width(), 640);
  Slam slam(calibration, "");
  EXPECT_THROW(slam.goOnWith(empty), InputError);
}

TEST(Slam, InertiaIsUsedWhereItIsConfiguredAndCanBe) {
  const SimulatedRobot& robot = simulatedRobot();
  const std::string unit = "imu_T_camera: {translation: [0, 0, 0], quaternion: [1, 0, 0, 0]}";
  const auto configured = [&](const std::string& imu) {
    return robot.folder.write("with_imu.yaml", "include: robot.yaml\nimu: {" + imu + "}\n");
  };
  EXPECT_THROW(Slam(configured("enabled: true")), InputError);
  Slam with(configured("enabled: true, " + unit)), without(configured(unit));
  InertialMeasurement measured{0, {0, 0, 0}, {0, 0, 9.8}};
  for (const double bad : {std::nan(""), HUGE_VAL, 1e9}) {
    measured.rotation_rate[1] = bad;
    EXPECT_THROW(with.add(measured), InputError) << bad;
  }
  // The unit says that the camera turns, which it does not: frames are predicted by it where it is used.
  measured.rotation_rate[1] = 0.5;
  bool differs = false;
  for (int i = 0; i < robot.frame_count; ++i) {
    const std::int64_t time_ns = robot.sequence.time(i);
    for (; measured.time_ns < time_ns + 5'000'000; measured.time_ns += 5'000'000) {
      with.add(measured);
      without.add(measured);
    }
    const PosedFrame one = with.process(robot.image(i), time_ns), other = without.process(robot.image(i), time_ns);
    EXPECT_FALSE(one.is_metric || other.is_metric) << "what contradicts the camera tells no metres";
    differs |= one.pose.position != other.pose.position || one.reason != other.reason;
  }
  EXPECT_TRUE(differs);
}

TEST(Slam, WheelsAreUsedWhereTheyAreConfiguredAndCanBe) {
  const SimulatedRobot& robot = simulatedRobot();
  const std::string configured =
      robot.folder.write("with_wheels.yaml", "include: robot.yaml\nwheels: {enabled: true}\n");
  Slam with(configured), without(robot.configuration);
  WheelMeasurement measured;
  for (const double bad : {std::nan(""), HUGE_VAL, 1e9}) {
    measured.position[1] = bad;
    EXPECT_THROW(with.add(measured), InputError) << bad;
  }
  measured.position[1] = 0;
  measured.orientation = {0.5, 0, 0, 0};
  EXPECT_THROW(with.add(measured), InputError);
  measured.orientation = {1, 0, 0, 0};
  // As the camera moves, in metres: a unit of the map is so many.
  bool is_metric = false;
  for (int i = 0; i < robot.frame_count; ++i) {
    const std::int64_t time_ns = robot.sequence.time(i);
    const Pose truth = robot.sequence.groundTruth(i);
    measured.time_ns = time_ns;
    Eigen::Map<Eigen::Vector3d>(measured.position.data()) = truth.translation;
    measured.orientation = {truth.rotation.w(), truth.rotation.x(), truth.rotation.y(), truth.rotation.z()};
    with.add(measured);
    without.add(measured);
    const PosedFrame frame = with.process(robot.image(i), time_ns);
    EXPECT_FALSE(without.process(robot.image(i), time_ns).is_metric);
    if (!frame.is_metric) continue;
    is_metric = true;
    EXPECT_GT(frame.scale_sigma, 0);
    EXPECT_EQ(frame.down[0], 0) << "wheels do not tell it";
  }
  EXPECT_TRUE(is_metric);
}

}  // namespace
}  // namespace edgeslam
