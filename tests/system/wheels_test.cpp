// Wheels beneath the camera: metres, poses while a hand is on the lens, and wheels that spin.
#include <gtest/gtest.h>

#include "system/measured_beside.h"

namespace edgeslam {
namespace {

constexpr int covered_from = 140, covered_to = 169;  // a second; the wheels spin from 220 on

class Wheels : public MeasuredBesideTest {
 protected:
  Wheels() : MeasuredBesideTest("wheeled") {}
};

TEST_F(Wheels, GiveMetresAlsoWhereTheySpin) {
  const ReplayedRun run = replayedWith("with", {"--wheels"});
  EXPECT_NE(run.outcome.output.find("lengths are metres"), std::string::npos) << run.outcome.output;
  const AbsoluteError error = errorOf("with");
  EXPECT_LT(error.translation.rmse, 0.02);
  EXPECT_NEAR(error.reference_T_estimate.scale, 1, 0.05);
}

TEST_F(Wheels, GivePosesWhileTheLensIsCovered) {
  const ReplayedRun with = replayedWith("with", {"--wheels"}), without = replayedWith("without", {});
  EXPECT_EQ(with.countGood(covered_from, covered_to), covered_to - covered_from + 1);
  EXPECT_LT(without.countGood(covered_from, covered_to), 3);
  const Trajectory truth = readTrajectory(input_ + "/groundtruth.txt");
  const AbsoluteError error = errorOf("with");
  double largest_m = 0;
  for (const StampedPose& pose : readTrajectory(folder_.path("with/trajectory.txt"))) {
    for (int i = covered_from; i <= covered_to; ++i) {
      const StampedPose& expected = truth[static_cast<std::size_t>(i)];
      if (expected.time_ns != pose.time_ns) continue;
      largest_m = std::max(
          largest_m,
          (error.reference_T_estimate * pose.world_T_camera.translation - expected.world_T_camera.translation).norm());
    }
  }
  EXPECT_LT(largest_m, 0.08);
}

TEST_F(Wheels, GiveTheSameBytesTwice) {
  replayedWith("once", {"--wheels"});
  replayedWith("twice", {"--wheels"});
  for (const char* name : {"/trajectory.txt", "/trajectory_live.txt", "/map.ply"}) {
    EXPECT_EQ(fileContent(folder_.path(std::string("once") + name)),
              fileContent(folder_.path(std::string("twice") + name)));
  }
}

TEST_F(Wheels, ARecordingRepeatsTheLiveRunToTheLastByte) {
  const ReplayedRun live = replayedWith("live", {"--wheels", "--realtime", "--record", folder_.path("recording")});
  EXPECT_NE(live.outcome.output.find("lengths are metres"), std::string::npos) << live.outcome.output;
  EXPECT_GE(live.countGood(covered_from, covered_to), live.count("lost", covered_from, covered_to));
  EXPECT_NE(fileContent(folder_.path("recording/decisions.txt")).find("\nwheels "), std::string::npos);
  const Outcome repeated =
      runProgram({"replay", folder_.path("recording"), "--output", folder_.path("repeated"), "--drawings", "0"});
  ASSERT_EQ(repeated.exit_code, 0) << repeated.messages;
  for (const char* name : {"trajectory.txt", "trajectory_live.txt", "keyframes.txt", "map.ply"}) {
    EXPECT_TRUE(fileContent(folder_.path("live") + "/" + name) == fileContent(folder_.path("repeated") + "/" + name))
        << name << "; " << repeated.messages;
  }
}

TEST_F(Wheels, TogetherWithInertiaAreNoWorseThanAlone) {
  const ReplayedRun both = replayedWith("both", {"--imu", "--wheels"});
  replayedWith("alone", {"--wheels"});
  EXPECT_NE(both.outcome.output.find("z is up"), std::string::npos) << both.outcome.output;
  EXPECT_EQ(both.countGood(covered_from, covered_to), covered_to - covered_from + 1);
  EXPECT_LT(errorOf("both").translation.rmse, 1.1 * errorOf("alone").translation.rmse + 0.001);
  EXPECT_NEAR(errorOf("both").reference_T_estimate.scale, 1, 0.05);
}

TEST_F(Wheels, AreNotUsedUnlessAskedFor) {
  const ReplayedRun run = replayedWith("without", {});
  EXPECT_NE(run.outcome.messages.find("wheel_odometry.txt is not used; --wheels uses it"), std::string::npos)
      << run.outcome.messages;
}

TEST_F(Wheels, ThatAreNotThereOrCannotBeUsedAreSaid) {
  for (const char* name : {"rgb", "rgb.txt", "camera.yaml"}) {
    std::filesystem::create_symlink(input_ + "/" + name, folder_.path(name));
  }
  const auto refused = [&](const std::string& input, const std::vector<std::string>& more, const std::string& message) {
    std::vector<std::string> arguments{"replay", input, "--wheels", "--output", folder_.path("no")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = runProgram(arguments);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.messages.find(message), std::string::npos) << outcome.messages;
  };
  refused(folder_.path(""), {}, "wheel_odometry.txt");
  folder_.write("wheel_odometry.txt", "1 2 3\n");
  refused(folder_.path(""), {}, "wheel_odometry.txt:1: ");
}

}  // namespace
}  // namespace edgeslam
