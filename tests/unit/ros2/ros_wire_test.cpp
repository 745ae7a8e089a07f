#include "drivers/ros2/ros_wire.h"

#include <gtest/gtest.h>

#include <fstream>

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

TEST(RosWire, WithoutTheLibraryOneLineTellsWhatToInstall) {
  const OpenedRosWire opened = openRosWire({}, {"/nowhere", "/neither"});
  EXPECT_FALSE(opened.wire);
  EXPECT_FALSE(opened.may_come);
  EXPECT_NE(opened.problem.find("libedgeslam_ros2_dds.so is not there"), std::string::npos) << opened.problem;
  EXPECT_NE(opened.problem.find("package edgeslam-ros2"), std::string::npos);
}

TEST(RosWire, AFileThatIsNoLibraryIsRefused) {
  const TemporaryFolder folder;
  std::ofstream(folder.path("libedgeslam_ros2_dds.so")) << "no library";
  const OpenedRosWire opened = openRosWire({}, {"/nowhere", folder.path("")});
  EXPECT_FALSE(opened.wire);
  EXPECT_FALSE(opened.may_come);
  EXPECT_NE(opened.problem.find(folder.path("libedgeslam_ros2_dds.so")), std::string::npos) << opened.problem;
}

}  // namespace
}  // namespace edgeslam
