#include "drivers/ros2/ros2_options.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace edgeslam {
namespace {

std::string problemOfNamespace(const std::string& name) {
  Ros2Options options;
  options.topic_namespace = name;
  return ros2Problem(options);
}

std::string problemOfBodyFrame(const std::string& name) {
  Ros2Options options;
  options.body_frame = name;
  return ros2Problem(options);
}

TEST(Ros2Options, TheDefaultsAreGood) { EXPECT_EQ(ros2Problem({}), ""); }

TEST(Ros2Options, ANamespaceIsOfWordsThatRos2Takes) {
  for (const char* good : {"robot1", "fleet/robot_1", "_hidden", "A"}) EXPECT_EQ(problemOfNamespace(good), "") << good;
  for (const std::string bad :
       {"/robot", "robot/", "a//b", "1robot", "a/2b", "a b", "a__b", "a-b", "r\xc3\xa4um", "~"}) {
    EXPECT_NE(problemOfNamespace(bad).find("ros2.namespace: '" + bad + "'"), std::string::npos) << bad;
  }
  EXPECT_NE(problemOfNamespace(std::string(300, 'a')), "");
}

TEST(Ros2Options, AFrameIsNoneThatTf2Refuses) {
  for (const char* good : {"base_footprint", "robot1/base_link", "base-link.2"}) {
    EXPECT_EQ(problemOfBodyFrame(good), "") << good;
  }
  for (const char* bad : {"", "/base_link", "base link", "b\n"}) {
    EXPECT_NE(problemOfBodyFrame(bad).find("ros2.body_frame"), std::string::npos) << bad;
  }
  EXPECT_NE(problemOfBodyFrame("odom").find("two are the same"), std::string::npos);
}

TEST(Ros2Options, TransformsAreAllOneOrNone) {
  Ros2Options options;
  for (const char* good : {"all", "map_to_odom", "none"}) {
    options.transforms = good;
    EXPECT_EQ(ros2Problem(options), "");
  }
  options.transforms = "both";
  EXPECT_NE(ros2Problem(options).find("ros2.transforms: 'both'"), std::string::npos);
}

class DomainOfTheEnvironment : public testing::Test {
 protected:
  void SetUp() override { unsetenv("ROS_DOMAIN_ID"); }
  void TearDown() override { unsetenv("ROS_DOMAIN_ID"); }
};

TEST_F(DomainOfTheEnvironment, CountsWhereTheConfigurationNamesNone) {
  Ros2Options options;
  EXPECT_EQ(effectiveDomain(options), 0);
  setenv("ROS_DOMAIN_ID", "42", 1);
  EXPECT_EQ(effectiveDomain(options), 42);
  options.domain = 7;
  EXPECT_EQ(effectiveDomain(options), 7);
}

TEST_F(DomainOfTheEnvironment, IsRefusedWhereItIsNone) {
  for (const char* bad : {"233", "-1", "one", "4294967296", " 1", "1.0"}) {
    setenv("ROS_DOMAIN_ID", bad, 1);
    EXPECT_THROW(effectiveDomain({}), InputError) << bad;
  }
}

}  // namespace
}  // namespace edgeslam
