#include "drivers/ros2/ros_diagnostics.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "edgeslam/state_t.hpp"

namespace edgeslam {
namespace {

status_t statusOf(std::int8_t state, const std::string& reason = "") {
  status_t status{};
  status.state = state;
  status.reason = reason;
  status.frames_per_second = 29.97;
  status.temperature_c = -1;
  return status;
}

bool has(const RosDiagnosis& diagnosis, const std::string& name, const std::string& value) {
  return std::count(diagnosis.values.begin(), diagnosis.values.end(), std::pair(name, value)) == 1;
}

TEST(RosDiagnostics, TheLevelIsThatOfTheState) {
  const auto levelOf = [](std::int8_t state) { return rosDiagnostics(statusOf(state), {}, "e", 0).parts.at(0).level; };
  EXPECT_EQ(levelOf(state_t::TRACKING), RosLevel::ok);
  EXPECT_EQ(levelOf(state_t::RELOCALISED), RosLevel::ok);
  EXPECT_EQ(levelOf(state_t::PREDICTED), RosLevel::warning);
  EXPECT_EQ(levelOf(state_t::INITIALISING), RosLevel::warning);
  EXPECT_EQ(levelOf(state_t::LOST), RosLevel::error);
  EXPECT_EQ(levelOf(99), RosLevel::error);
}

TEST(RosDiagnostics, TheReasonIsTold) {
  const RosDiagnosis pose = rosDiagnostics(statusOf(state_t::LOST, "no camera"), {}, "robot1/edgeslam", 7).parts.at(0);
  EXPECT_EQ(pose.name, "robot1/edgeslam: pose");
  EXPECT_EQ(pose.message, "lost: no camera");
}

TEST(RosDiagnostics, FiguresThatAreNotKnownAreLeftOut) {
  const RosDiagnosis pose = rosDiagnostics(statusOf(state_t::TRACKING), {}, "e", 0).parts.at(0);
  EXPECT_TRUE(has(pose, "frames per second", "29.97"));
  EXPECT_TRUE(std::none_of(pose.values.begin(), pose.values.end(),
                           [](const auto& value) { return value.first == "temperature [C]"; }));
}

TEST(RosDiagnostics, AScaleThatIsNotKnownIsAWarning) {
  EXPECT_EQ(rosDiagnostics(statusOf(state_t::TRACKING), {}, "e", 0).parts.at(1).level, RosLevel::warning);
  const RosDiagnosis known =
      rosDiagnostics(statusOf(state_t::TRACKING), {ScaleKind::odometry, 0.25, 0.02}, "e", 0).parts.at(1);
  EXPECT_EQ(known.level, RosLevel::ok);
  EXPECT_TRUE(has(known, "metres per map unit", "0.25"));
  EXPECT_TRUE(has(known, "standard deviation [%]", "2"));
}

}  // namespace
}  // namespace edgeslam
