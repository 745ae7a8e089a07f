// Wheel odometry beside frames, and what is said of files that cannot be used.
#include "frames/wheel_file.h"

#include "frames/frame_source.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

const std::string odometry_text =
    "# timestamp tx ty tz qx qy qz qw\n"
    "1000.010000 0.1 0.2 0 0 0 0 1\n"
    "1000.030000, 0.2, 0.2, 0, 0, 0, 0.6, 0.8\n";

std::vector<OdometryPose> odometryOf(const std::string& content) {
  const TemporaryFolder folder;
  return readWheelOdometry(folder.write("wheel_odometry.txt", content));
}

template <typename... Texts>
void expectOdometryRefused(const std::string& content, const Texts&... messages) {
  SCOPED_TRACE(content);
  expectInputError([&] { odometryOf(content); }, "wheel_odometry.txt", messages...);
}

TEST(WheelFile, ReadsPoses) {
  const std::vector<OdometryPose> poses = odometryOf(odometry_text);
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].utime, 1000'010'000);
  EXPECT_EQ(poses[1].local_T_body.translation, Eigen::Vector3d(0.2, 0.2, 0));
  EXPECT_DOUBLE_EQ(poses[1].local_T_body.rotation.w(), 0.8);
  EXPECT_DOUBLE_EQ(poses[1].local_T_body.rotation.z(), 0.6);
}

TEST(WheelFile, LeavesOutATornLine) {
  EXPECT_EQ(odometryOf(odometry_text + "1000.05 0.3 0.").size(), 2U);
  expectOdometryRefused(odometry_text + "1000.05 0.3 0.\n", ":4: ", "8 columns");
}

TEST(WheelFile, SaysWhatIsWrong) {
  expectOdometryRefused("", "no poses");
  expectOdometryRefused("# nothing but this\n", "no poses");
  expectOdometryRefused("1 2 3\n", ":1: ", "8 columns");
  expectOdometryRefused("1 0 0 0 0 0 0 1 5\n", ":1: ", "8 columns");
  expectOdometryRefused("1 nan 0 0 0 0 0 1\n", ":1: ", "8 columns");
  expectOdometryRefused("1 0 0 inf 0 0 0 1\n", ":1: ", "8 columns");
  expectOdometryRefused("1 0 0 0 0 0 0 0\n", ":1: ", "quaternion");
  expectOdometryRefused("1 0 0 0 0 0 0 2\n", ":1: ", "quaternion");
  expectOdometryRefused("1 1e9 0 0 0 0 0 1\n", ":1: ", "1000 km");
  expectOdometryRefused("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", ":2: ", "not after");
  expectOdometryRefused("2 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n", ":2: ", "not after");
}

}  // namespace
}  // namespace edgeslam
