#include "drivers/ros2/ros2_sender.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "unit/lcm/comes_true.h"

namespace edgeslam {
namespace {

TEST(Ros2Sender, ADomainOfTheEnvironmentThatIsNoneIsToldInOneLine) {
  setenv("ROS_DOMAIN_ID", "kitchen", 1);
  Ros2Sender sender({}, 0);
  std::optional<std::string> event;
  EXPECT_TRUE(comesTrue([&] { return (event = sender.nextEvent()).has_value(); }));
  unsetenv("ROS_DOMAIN_ID");
  ASSERT_TRUE(event);
  for (int i = 0; i < 10000; ++i) sender.send(RosFrame());  // nothing waits for what is not there
  EXPECT_EQ(*event, "ROS 2: left out: ROS_DOMAIN_ID 'kitchen' is no domain; expected 0 to 232");
}

}  // namespace
}  // namespace edgeslam
