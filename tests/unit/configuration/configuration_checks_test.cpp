#include "configuration/configuration_checks.h"

#include <gtest/gtest.h>

#include "configuration/configuration_text.h"
#include "unit/configuration/configuration_file.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

void expectLineRefused(const std::string& text, const std::string& line, const std::string& part) {
  expectInputError([&] { configurationOf(text); }, "file.yaml:" + line + ": ", part);
}

const char* const whole_file =
    "lcm:\n"
    "  url: udpm://239.1.2.3:7000\n"
    "  ttl: 1\n"
    "  pose_channel: HEAD_POSE\n"
    "  map_interval_s: 2.5\n"
    "map:\n"
    "  file: /var/lib/edgeslam/robot map\n"
    "  go_on: true\n"
    "recording:\n"
    "  folder: recordings\n"
    "  from_start: true\n"
    "  most_megabytes: 100\n"
    "  kept_free_megabytes: 50\n"
    "scale:\n"
    "  source: odometry\n"
    "  camera_height_m: 0.42\n"
    "  camera_height_sigma_m: 0.02\n"
    "  ground_tilt_deg: 5\n"
    "  odometry_channel: WHEELS\n"
    "  odometry_sigma: 0.03\n"
    "  odometry_sigma_per_metre: 0.1\n"
    "  odometry_window_m: 0.4\n"
    "  largest_sigma: 0.2\n"
    "  metres_per_unit: 1.5\n"
    "  sigma: 0.01\n"
    "viewer:\n"
    "  enabled: true\n"
    "  address: 0.0.0.0\n"
    "  port: 8080\n"
    "  token: 0123456789abcdef\n";

TEST(ConfigurationService, ReadsEveryKey) {
  const ServiceOptions service = configurationOf(whole_file).service;
  EXPECT_EQ(service.lcm.url, "udpm://239.1.2.3:7000");
  EXPECT_EQ(service.lcm.time_to_live, 1);
  EXPECT_EQ(service.lcm.pose_channel, "HEAD_POSE");
  EXPECT_EQ(service.lcm.state_channel, "SLAM_STATE");
  EXPECT_EQ(service.map_interval_s, 2.5);
  EXPECT_EQ(service.map_file, "/var/lib/edgeslam/robot map");
  EXPECT_TRUE(service.goes_on_with_map);
  EXPECT_EQ(service.recordings_folder, "recordings");
  EXPECT_TRUE(service.records_from_start);
  EXPECT_EQ(configurationOf(whole_file).settings.recording.most_megabytes, 100);
  EXPECT_EQ(configurationOf(whole_file).settings.recording.kept_free_megabytes, 50);
  EXPECT_EQ(service.scale.source, "odometry");
  EXPECT_EQ(service.scale.height.camera_height_m, 0.42);
  EXPECT_EQ(service.scale.height.sigma_m, 0.02);
  EXPECT_EQ(service.scale.height.largest_tilt_deg, 5);
  EXPECT_EQ(service.scale.odometry.channel, "WHEELS");
  EXPECT_EQ(service.scale.odometry.sigma, 0.03);
  EXPECT_EQ(service.scale.odometry.sigma_per_metre, 0.1);
  EXPECT_EQ(service.scale.odometry.window_m, 0.4);
  EXPECT_EQ(service.scale.largest_sigma, 0.2);
  EXPECT_EQ(service.scale.metres_per_unit, 1.5);
  EXPECT_EQ(service.scale.sigma, 0.01);
  EXPECT_TRUE(service.viewer.enabled);
  EXPECT_EQ(service.viewer.address, "0.0.0.0");
  EXPECT_EQ(service.viewer.port, 8080);
  EXPECT_EQ(service.viewer.token, "0123456789abcdef");
}

TEST(ConfigurationService, ThePageIsOffAndForThisComputerAlone) {
  const ViewerOptions viewer = Configuration().service.viewer;
  EXPECT_FALSE(viewer.enabled);
  EXPECT_EQ(viewer.address, "127.0.0.1");
  EXPECT_EQ(viewer.token, "");
}

// Recordings and results keep the configuration that they were made with.
TEST(ConfigurationService, TheTokenIsNotWrittenAnywhere) {
  EXPECT_EQ(formatConfiguration(configurationOf(whole_file)).find("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(formatConfiguration(configurationOf("viewer: {enabled: true}\n")), formatConfiguration(Configuration()));
}

TEST(ConfigurationService, WhatIsWrittenReadsBackAsTheSame) {
  const std::string text = formatConfiguration(configurationOf(whole_file));
  EXPECT_EQ(formatConfiguration(configurationOf(text)), text);
}

TEST(ConfigurationService, WhatIsWrongIsToldByLineAndKey) {
  expectLineRefused("map:\n  go_no: true\n", "2", "map.go_no is not a key; did you mean map.go_on?");
  expectLineRefused("map:\n  go_on: maybe\n", "2", "map.go_on");
  expectLineRefused("map:\n  file: [a]\n", "2", "map.file: a text is expected");
  expectLineRefused("map:\n  file: ''\n", "2", "map.file: a text of 1 to 1000 letters is expected");
  expectLineRefused("recording:\n  most_megabytes: 0\n", "2", "recording.most_megabytes: 0 is out of range");
  expectLineRefused("scale:\n  metres_per_unit: nan\n", "2", "scale.metres_per_unit");
  expectLineRefused("scale:\n  source: wheels\n", "2",
                    "scale.source: 'wheels' is no source; expected none, camera_height or odometry");
  expectLineRefused("scale:\n  source: camera_height\n", "2", "camera_height needs scale.camera_height_m");
  expectLineRefused("scale:\n  source: odometry\n", "2", "odometry needs scale.odometry_channel");
  expectLineRefused("scale:\n  source: odometry\n  odometry_channel: my wheels\n", "2", "scale.odometry_channel: ");
  expectLineRefused("scale:\n  source: odometry\n  odometry_channel: SLAM_POSE\n", "2", "is named twice");
  // In whichever order the sections come.
  expectLineRefused("scale: {source: odometry, odometry_channel: A}\nlcm:\n  pose_channel: A\n", "3", "is named twice");
  expectLineRefused("wheels: {enabled: true}\nscale: {odometry_channel: A}\nlcm:\n  pose_channel: A\n", "4",
                    "is named twice");
  expectLineRefused("scale: {odometry_channel: my wheels}\nwheels:\n  enabled: true\n", "3",
                    "scale.odometry_channel: ");
  expectLineRefused("scale:\n  odometry_window_m: 0\n", "2", "scale.odometry_window_m: 0 is out of range");
  expectLineRefused("scale:\n  camera_height_m: -1\n", "2", "scale.camera_height_m: -1 is out of range");
  expectLineRefused("lcm:\n  ttl: 256\n", "2", "lcm.ttl: 256 is out of range");
  expectLineRefused("lcm:\n  url: nonsense\n", "2", "lcm: ");
  expectLineRefused("lcm:\n  pose_channel: SLAM_STATE\n", "2", "lcm: ");
  expectLineRefused("viewer:\n  enabled: true\n  address: 0.0.0.0\n", "2", "viewer.token is needed");
  expectLineRefused("viewer:\n  address: robot\n", "2", "viewer.address: 'robot' is no address");
  expectLineRefused("viewer:\n  token: short\n", "2", "viewer.token: expected 16 to 128");
  expectLineRefused("viewer:\n  port: 0\n", "2", "viewer.port: 0 is out of range");
  expectLineRefused("viewer:\n  adress: 127.0.0.1\n", "2", "did you mean viewer.address?");
  expectLineRefused("ros2:\n  namespace: 1robot\n", "2", "ros2.namespace: '1robot' is none");
  expectLineRefused("ros2:\n  transforms: odom\n", "2", "ros2.transforms: 'odom' is not known");
  expectLineRefused("ros2:\n  domain: 233\n", "2", "ros2.domain: 233 is out of range");
  expectLineRefused("lcm: 5\n", "1", "lcm: a mapping of keys is expected");
}

}  // namespace
}  // namespace edgeslam
