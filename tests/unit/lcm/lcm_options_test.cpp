#include "drivers/lcm/lcm_options.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

LcmOptions withUrl(const std::string& url, int time_to_live = -1) {
  LcmOptions options;
  options.url = url;
  options.time_to_live = time_to_live;
  return options;
}

TEST(LcmOptions, TheEnvironmentOrLcmsOwnDefault) {
  unsetenv("LCM_DEFAULT_URL");
  EXPECT_EQ(effectiveUrl({}), "udpm://239.255.76.67:7667?ttl=0");
  setenv("LCM_DEFAULT_URL", "udpm://239.255.76.68:7000?ttl=1", 1);
  EXPECT_EQ(effectiveUrl({}), "udpm://239.255.76.68:7000?ttl=1");
  EXPECT_EQ(effectiveUrl(withUrl("memq://")), "memq://");
  unsetenv("LCM_DEFAULT_URL");
}

TEST(LcmOptions, TimeToLiveTakesThePlaceOfTheUrls) {
  EXPECT_EQ(effectiveUrl(withUrl("udpm://", 1)), "udpm://?ttl=1");
  EXPECT_EQ(effectiveUrl(withUrl("udpm://239.1.1.1:80?ttl=0&recv_buf_size=9", 2)),
            "udpm://239.1.1.1:80?recv_buf_size=9&ttl=2");
  EXPECT_EQ(effectiveUrl(withUrl("file:///tmp/x?mode=w", 2)), "file:///tmp/x?mode=w");
}

TEST(LcmOptions, GroupsAreRead) {
  const auto group = multicastGroup("udpm://239.1.2.3:7000?ttl=3");
  ASSERT_TRUE(group);
  EXPECT_EQ(group->address, "239.1.2.3");
  EXPECT_EQ(group->port, 7000);
  EXPECT_EQ(group->time_to_live, 3);
  EXPECT_EQ(multicastGroup("udpm://")->address, "239.255.76.67");
  EXPECT_EQ(multicastGroup("udpm://:7668")->port, 7668);
  EXPECT_FALSE(multicastGroup("tcpq://robot:7700"));
}

TEST(LcmOptions, MistakesAreTold) {
  expectInputError([] { effectiveUrl(withUrl("239.255.76.67:7667")); }, "239.255.76.67:7667", "PROVIDER://NETWORK");
  expectInputError([] { effectiveUrl(withUrl("udp://239.255.76.67")); }, "'udp' is no provider");
  expectInputError([] { effectiveUrl(withUrl("udpm://robot:7667")); }, "'robot' is no multicast group");
  expectInputError([] { effectiveUrl(withUrl("udpm://192.168.0.1:7667")); }, "no multicast group");
  expectInputError([] { effectiveUrl(withUrl("udpm://239.255.76.67:0")); }, "'0' is no port");
  expectInputError([] { effectiveUrl(withUrl("udpm://239.255.76.67:99999999999")); }, "is no port");
  expectInputError([] { effectiveUrl(withUrl("udpm://239.255.76.67:7667?ttl=-1")); }, "'-1' is no time to live");
  expectInputError([] { effectiveUrl(withUrl("udpm://239.255.76.67:7667?ttl")); }, "'' is no time to live");
  expectInputError([] { effectiveUrl(withUrl("udpm://", 256)); }, "0 to 255");
}

TEST(LcmOptions, ChannelsArePlainNamesAndDiffer) {
  EXPECT_NO_THROW(checkChannels({}));
  for (const std::string name : {"", "SLAM POSE", "SLAM.*", "S,", "ä"}) {
    LcmOptions options;
    options.map_channel = name;
    expectInputError([&] { checkChannels(options); }, "LCM channel '" + name + "'", "letters");
  }
  LcmOptions options;
  options.pose_channel = std::string(64, 'A');
  expectInputError([&] { checkChannels(options); }, "1 to 63");
  options.pose_channel = options.state_channel;
  expectInputError([&] { checkChannels(options); }, "'SLAM_STATE' is named twice");
  options.pose_channel = "SLAM_POSE";
  options.map_lines_channel = options.map_channel;
  expectInputError([&] { checkChannels(options); }, "'SLAM_MAP' is named twice");
}

}  // namespace
}  // namespace edgeslam
