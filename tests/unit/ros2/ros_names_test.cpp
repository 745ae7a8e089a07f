#include "drivers/ros2/ros_names.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

TEST(RosNames, TopicsAreInTheirNamespace) {
  EXPECT_EQ(rosTopic("", "odom"), "/odom");
  EXPECT_EQ(rosTopic("fleet/robot1", "odom"), "/fleet/robot1/odom");
}

TEST(RosNames, DdsHasThemBehindRt) {
  EXPECT_EQ(ddsTopic("/tf"), "rt/tf");
  EXPECT_EQ(ddsTopic(rosTopic("robot1", "odom")), "rt/robot1/odom");
}

TEST(RosNames, EveryWorldHasAFrameOfItsOwn) {
  EXPECT_EQ(mapFrame("map", 0), "map");
  EXPECT_EQ(mapFrame("map", -1), "map");
  EXPECT_EQ(mapFrame("map", 2), "map_2");
}

}  // namespace
}  // namespace edgeslam
