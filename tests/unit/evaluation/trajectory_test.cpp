#include "evaluation/trajectory.h"

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

TEST(Trajectory, SurvivesWritingAndReading) {
  Trajectory written;
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d rotation(0.1 * i, -0.05 * i, 0.02 * i);
    written.push_back(
        {1403636579763555584 + i * 33333333LL, {rotationExp(rotation), {1e-7 * i, -1234.5678901 * i, 1e6 / (i + 1)}}});
  }
  const TemporaryFolder folder;
  const Trajectory read = readTrajectory(folder.write("t.txt", formatTrajectory(written)));
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].time_ns, written[i].time_ns);
    const Eigen::Vector3d& expected = written[i].world_T_camera.translation;
    EXPECT_LE((read[i].world_T_camera.translation - expected).norm(), 1e-8 * expected.norm());
    EXPECT_LE(rotationAngle(read[i].world_T_camera.rotation, written[i].world_T_camera.rotation), 1e-7);
  }
}

TEST(Trajectory, IsWrittenInTumFormat) {
  const Trajectory one{{1500000000, {Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), {1, -0.0, 1.0 / 3}}}};
  EXPECT_EQ(formatTrajectory(one), "# timestamp tx ty tz qx qy qz qw\n1.500000000 1 0 0.333333333 0.5 -0.5 0.5 0.5\n");
}

TEST(Trajectory, ReadsEurocGroundTruth) {
  const TemporaryFolder folder;
  const Trajectory read = readTrajectory(
      folder.write("data.csv",
                   "#timestamp, p_RS_R_x [m], ...\r\n"
                   "1403636580838555648,4.688319,-1.786938,0.783338,0.5,-0.5,0.5,-0.5,0,0,0,0,0,0,0,0,0\r\n"));
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].time_ns, 1403636580838555648);
  EXPECT_EQ(read[0].world_T_camera.translation, Eigen::Vector3d(4.688319, -1.786938, 0.783338));
  EXPECT_EQ(read[0].world_T_camera.rotation.coeffs(), Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5).coeffs());
}

TEST(Trajectory, IsSortedAndItsQuaternionsAreUnit) {
  const TemporaryFolder folder;
  const Trajectory read = readTrajectory(folder.write("t.txt", "2 0 0 0 0 0 0 2\n1 0 0 0 0 0 3 0\n"));
  ASSERT_EQ(read.size(), 2U);
  EXPECT_LT(read[0].time_ns, read[1].time_ns);
  for (const StampedPose& stamped : read) EXPECT_NEAR(stamped.world_T_camera.rotation.norm(), 1, 1e-15);
}

TEST(Trajectory, MistakesAreToldByLine) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& line) {
    return [&folder, line] { readTrajectory(folder.write("t.txt", "# a\n1 0 0 0 0 0 0 1\n" + line + "\n")); };
  };
  expectInputError(read("2 0 0 0 0 0 0"), "t.txt:3", "8 columns", "found 7");
  expectInputError(read("2 0 nan 0 0 0 0 1"), "t.txt:3", "column 3", "nan", "finite");
  expectInputError(read("2 0 0 1e400 0 0 0 1"), "t.txt:3", "column 4");
  expectInputError(read("x 0 0 0 0 0 0 1"), "t.txt:3", "time stamp");
  expectInputError(read("2 0 0 0 0 0 0 0"), "t.txt:3", "quaternion");
  expectInputError(read("2 0 0 0 0 0 0 1e-9"), "t.txt:3", "quaternion");
  expectInputError(read("2 0 -1e13 0 0 0 0 1"), "t.txt:3", "beyond");
  expectInputError([&] { readTrajectory(folder.write("t.txt", "# nothing\n")); }, "t.txt", "no poses");
  expectInputError([&] { readTrajectory(folder.path("none.txt")); }, "none.txt", "no such file");
}

TEST(Trajectory, HugeQuaternionsStayUnit) {
  const TemporaryFolder folder;
  for (const char* quaternion : {"0 0 1e300 1e300", "1.7e308 -1.7e308 1.7e308 1.7e308"}) {
    const Trajectory read = readTrajectory(folder.write("t.txt", "1 0 0 0 " + std::string(quaternion) + "\n"));
    EXPECT_NEAR(read[0].world_T_camera.rotation.norm(), 1, 1e-15) << quaternion;
  }
}

}  // namespace
}  // namespace edgeslam
