#include "service/run_log.h"

#include <gtest/gtest.h>

#include <sstream>

namespace edgeslam {
namespace {

class RunLogTest : public testing::Test {
 protected:
  std::string said() {
    EXPECT_TRUE(log_.waitUntilOut());
    return said_.str();
  }

  std::ostringstream said_;
  EventLog log_{said_};
  RunLog run_log_{log_};
};

TEST_F(RunLogTest, AStateIsToldWhenItChanges) {
  for (const char* state : {"tracking", "tracking", "", "tracking", "lost, covered"}) run_log_.tellChanges(state, "");
  EXPECT_EQ(said(), "edgeslam: state: tracking\nedgeslam: state: lost, covered\n");
}

TEST_F(RunLogTest, AChangeOfTheWorldIsToldWithItsFrame) {
  run_log_.tellWorld(120, "back in map 0 from map 1: found again there");
  EXPECT_EQ(said(), "edgeslam: frame 120: back in map 0 from map 1: found again there\n");
}

TEST_F(RunLogTest, MessagesThatDoNotGoOutAreToldAndThatTheyDoAgain) {
  for (const char* problem : {"", "no route", "no route", ""}) run_log_.tellChanges("", problem);
  EXPECT_EQ(said(), "edgeslam: messages do not go out: no route\nedgeslam: messages go out again\n");
}

TEST_F(RunLogTest, OfReportsLoopsFoundFramesAndWhatIsToBeConfiguredAreTold) {
  MappingReport report;
  report.frame_index = 7;
  report.events = {"keyframe 3 was culled"};
  run_log_.report(report);
  report.loop = ClosedLoop();
  report.events = {"loop closed"};
  run_log_.report(report);
  report.loop.reset();
  report.is_of_setup = true;
  report.events = {"the clocks differ"};
  run_log_.report(report);
  EXPECT_EQ(said(), "edgeslam: frame 7: loop closed\nedgeslam: frame 7: the clocks differ\n");
}

}  // namespace
}  // namespace edgeslam
