// Inertial data beside the frames: metres, upright, and poses while a hand is on the lens.
#include <gtest/gtest.h>

#include "system/measured_beside.h"

namespace edgeslam {
namespace {

constexpr int covered_from = 200, covered_to = 214;

class Inertia : public MeasuredBesideTest {
 protected:
  Inertia() : MeasuredBesideTest("inertial") {}
};

TEST_F(Inertia, GivesMetresAndUpright) {
  const ReplayedRun run = replayedWith("with", {"--imu"});
  EXPECT_NE(run.outcome.output.find("lengths are metres"), std::string::npos) << run.outcome.output;
  const AbsoluteError error = errorOf("with");
  EXPECT_LT(error.translation.rmse, 0.01);
  EXPECT_NEAR(error.reference_T_estimate.scale, 1, 0.02);
  const Eigen::Vector3d up = error.reference_T_estimate.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_LT(std::acos(up.z()), 0.01) << "the world's z is not up";
}

TEST_F(Inertia, GivesPosesWhileTheLensIsCovered) {
  const ReplayedRun with = replayedWith("with", {"--imu"}), without = replayedWith("without", {});
  EXPECT_EQ(with.countGood(covered_from, covered_to), covered_to - covered_from + 1);
  EXPECT_LT(without.countGood(covered_from, covered_to), 3);
  double largest_m = 0;
  const AbsoluteError error = errorOf("with");
  const Trajectory truth = readTrajectory(input_ + "/groundtruth.txt");
  int compared = 0;
  for (const StampedPose& pose : readTrajectory(folder_.path("with/trajectory.txt"))) {
    for (int i = covered_from; i <= covered_to; ++i) {
      const StampedPose& expected = truth[static_cast<std::size_t>(i)];
      if (expected.time_ns != pose.time_ns) continue;
      ++compared;
      largest_m = std::max(
          largest_m,
          (error.reference_T_estimate * pose.world_T_camera.translation - expected.world_T_camera.translation).norm());
    }
  }
  EXPECT_EQ(compared, covered_to - covered_from + 1);
  EXPECT_LT(largest_m, 0.05);
}

// From the first pose on, also by the camera alone: the robot that is switched on again knows how large its map is.
TEST_F(Inertia, GivesMetresToWhoeverGoesOnWithTheMap) {
  const std::string map = folder_.path("saved.map");
  replayedWith("before", {"--imu", "--map-out", map});
  const Outcome info = runProgram({"map", "info", map});
  EXPECT_NE(info.output.find(" m +- "), std::string::npos) << info.output;
  for (const std::vector<std::string>& with : {std::vector<std::string>{}, std::vector<std::string>{"--imu"}}) {
    const std::string name = with.empty() ? "camera" : "unit";
    std::vector<std::string> more{"--map-in", map};
    more.insert(more.end(), with.begin(), with.end());
    const ReplayedRun run = replayedWith(name, more);
    EXPECT_NE(run.outcome.output.find("lengths are metres"), std::string::npos) << run.outcome.output;
    const AbsoluteError error = errorOf(name);
    EXPECT_LT(error.translation.rmse, 0.01);
    EXPECT_NEAR(error.reference_T_estimate.scale, 1, 0.02);
    const Eigen::Vector3d up = error.reference_T_estimate.rotation * Eigen::Vector3d::UnitZ();
    EXPECT_LT(std::acos(up.z()), 0.01) << "the world's z is not up";
  }
}

TEST_F(Inertia, GivesTheSameBytesTwice) {
  replayedWith("once", {"--imu"});
  replayedWith("twice", {"--imu"});
  for (const char* name : {"/trajectory.txt", "/trajectory_live.txt", "/map.ply"}) {
    EXPECT_EQ(fileContent(folder_.path(std::string("once") + name)),
              fileContent(folder_.path(std::string("twice") + name)));
  }
}

TEST_F(Inertia, IsNotUsedUnlessAskedFor) {
  const ReplayedRun run = replayedWith("without", {});
  EXPECT_NE(run.outcome.messages.find("imu.csv is not used; --imu uses it"), std::string::npos) << run.outcome.messages;
}

TEST_F(Inertia, ThatIsNotThereOrCannotBeUsedIsSaid) {
  for (const char* name : {"rgb", "rgb.txt", "camera.yaml"}) {
    std::filesystem::create_symlink(input_ + "/" + name, folder_.path(name));
  }
  const Outcome missing = runProgram({"replay", folder_.path(""), "--imu", "--output", folder_.path("no")});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_NE(missing.messages.find("imu.csv"), std::string::npos) << missing.messages;
}

// The run goes on all the same.
TEST_F(Inertia, ThatIsCutOffIsSaid) {
  for (const char* name : {"rgb", "rgb.txt", "camera.yaml", "imu.yaml"}) {
    std::filesystem::create_symlink(input_ + "/" + name, folder_.path(name));
  }
  // Its turns about z go beyond what the unit can measure for a moment.
  std::istringstream samples(fileContent(input_ + "/imu.csv"));
  std::string line, cut;
  for (int i = 0; std::getline(samples, line); ++i) {
    if (i > 1000 && i <= 1006) {
      std::size_t z = 0;
      for (int column = 0; column < 3; ++column) z = line.find(',', z) + 1;
      line.replace(z, line.find(',', z) - z, " 4.36");
    }
    cut += line + "\n";
  }
  folder_.write("imu.csv", cut);
  const Outcome outcome =
      runProgram({"replay", folder_.path(""), "--imu", "--output", folder_.path("cut"), "--drawings", "0"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.messages.find("imu.csv: the gyroscope is cut off at 4.36 rad/s along its z axis"),
            std::string::npos)
      << outcome.messages;
}

TEST_F(Inertia, ARecordingRepeatsTheLiveRunToTheLastByte) {
  replayedWith("live", {"--imu", "--realtime", "--record", folder_.path("recording")});
  EXPECT_NE(fileContent(folder_.path("recording/decisions.txt")).find("\ninertia "), std::string::npos);
  const Outcome repeated =
      runProgram({"replay", folder_.path("recording"), "--output", folder_.path("repeated"), "--drawings", "0"});
  ASSERT_EQ(repeated.exit_code, 0) << repeated.messages;
  for (const char* name : {"trajectory.txt", "trajectory_live.txt", "keyframes.txt", "map.ply"}) {
    EXPECT_TRUE(fileContent(folder_.path("live") + "/" + name) == fileContent(folder_.path("repeated") + "/" + name))
        << name << "; " << repeated.messages;
  }
}

}  // namespace
}  // namespace edgeslam
