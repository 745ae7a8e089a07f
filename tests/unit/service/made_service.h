// What the parts of a publisher work with: a log that can be read, a way out that leads nowhere, a run that stands.
#pragma once

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "drivers/lcm/lcm_publisher.h"
#include "pipeline/live_run.h"
#include "service/background_work.h"
#include "service/command_answers.h"
#include "service/event_log.h"

namespace edgeslam {

inline Camera smallCamera() {
  Camera camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 300;
  camera.cx = 160;
  camera.cy = 120;
  return camera;
}

class MadeService : public testing::Test {
 protected:
  // All that the log was told so far.
  std::string said() {
    EXPECT_TRUE(log_.waitUntilOut());
    return said_.str();
  }
  void finishWork() {
    work_.finish();
    work_.complete();
  }

  std::ostringstream said_;
  EventLog log_{said_};
  LcmPublisher publisher_{nowhere(), Pose()};
  CommandAnswers answers_{publisher_, nullptr};
  BackgroundWork work_;
  LiveRun run_{smallCamera(), Settings(), LiveOptions(), LiveObserver(), nullptr};

 private:
  static LcmOptions nowhere() {
    LcmOptions options;
    options.url = "memq://";
    return options;
  }
};

}  // namespace edgeslam
