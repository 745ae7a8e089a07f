#include "service/daemon_setup.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

TEST(DaemonSetup, OnlyCommandsThatCanBeCarriedOutAreOffered) {
  DaemonSetup setup;
  setup.for_viewing = true;
  EXPECT_EQ(commandsOf(setup), (std::vector<std::string>{"reset", "set_scale"}));
  setup.for_viewing = false;
  setup.map_out = "robot.map";
  setup.configuration.service.recordings_folder = "recordings";
  EXPECT_EQ(commandsOf(setup), (std::vector<std::string>{"reset", "set_scale", "save_map", "start_recording",
                                                         "stop_recording", "send_map"}));
}

TEST(DaemonSetup, NeedsTheHighestPriorityAndTheFolderThatIsWrittenTo) {
  DaemonSetup setup;
  setup.configuration.settings.threads.capture_priority = 12;
  setup.configuration.settings.threads.tracking_priority = 55;
  setup.map_out = "/srv/maps/robot.map";
  EXPECT_EQ(startNeeds(setup).real_time_priority, 55);
  EXPECT_EQ(startNeeds(setup).folder, "/srv/maps");
  setup.configuration.service.recordings_folder = "/srv/recordings";
  EXPECT_EQ(startNeeds(setup).folder, "/srv/recordings");
}

// Who is to have what the wheels say: the map, which then has metres by itself, or the search for the scale.
TEST(DaemonSetup, WheelsAreForTheMapOrForTheScale) {
  DaemonSetup setup;
  ScaleOptions& scale = setup.configuration.service.scale;
  scale.odometry.channel = "WHEELS";
  EXPECT_EQ(publishingSetup(setup, nullptr).lcm.wheels_channel, "");
  scale.source = "odometry";
  EXPECT_EQ(publishingSetup(setup, nullptr).lcm.wheels_channel, "WHEELS");
  EXPECT_EQ(publishingSetup(setup, nullptr).scale.source, "odometry");
  setup.configuration.settings.wheels.enabled = true;
  setup.configuration.settings = settingsWithSensors(setup.configuration);
  EXPECT_EQ(publishingSetup(setup, nullptr).lcm.wheels_channel, "WHEELS");
  EXPECT_EQ(publishingSetup(setup, nullptr).scale.source, "none");
  scale.source = "camera_height";
  EXPECT_EQ(publishingSetup(setup, nullptr).scale.source, "camera_height");
}

}  // namespace
}  // namespace edgeslam
