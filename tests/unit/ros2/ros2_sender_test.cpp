#include "drivers/ros2/ros2_sender.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "unit/lcm/comes_true.h"

namespace edgeslam {
namespace {

// This program does not find the library: it is not beside it.
TEST(Ros2Sender, WithoutTheLibraryOneLineTellsItAndNothingWaits) {
  Ros2Sender sender({}, 0);
  std::optional<std::string> event;
  ASSERT_TRUE(comesTrue([&] { return (event = sender.nextEvent()).has_value(); }));
  EXPECT_EQ(event->rfind("ROS 2: left out: libedgeslam_ros2_dds.so: ", 0), 0U) << *event;
  EXPECT_NE(event->find("package edgeslam-ros2"), std::string::npos);
  EXPECT_EQ(event->find('\n'), std::string::npos);
  for (int i = 0; i < 10000; ++i) sender.send(RosFrame());
  EXPECT_FALSE(sender.nextEvent());
}

TEST(Ros2Sender, ADomainOfTheEnvironmentThatIsNoneIsToldInOneLine) {
  setenv("ROS_DOMAIN_ID", "kitchen", 1);
  Ros2Sender sender({}, 0);
  std::optional<std::string> event;
  EXPECT_TRUE(comesTrue([&] { return (event = sender.nextEvent()).has_value(); }));
  unsetenv("ROS_DOMAIN_ID");
  ASSERT_TRUE(event);
  EXPECT_EQ(*event, "ROS 2: left out: ROS_DOMAIN_ID 'kitchen' is no domain; expected 0 to 232");
}

}  // namespace
}  // namespace edgeslam
