// What goes out, on which channel and in which order, by LCM's own log files: no network needed.
#include "drivers/lcm/lcm_publisher.h"

#include <gtest/gtest.h>

#include <lcm/lcm-cpp.hpp>
#include <map>

#include "drivers/lcm/messages.h"
#include "unit/files/temporary_folder.h"
#include "unit/lcm/comes_true.h"
#include "unit/lcm/made_frames.h"

namespace edgeslam {
namespace {

struct LoggedMessage {
  std::string channel;
  std::vector<std::uint8_t> bytes;

  template <class Message>
  Message as() const {
    Message message;
    EXPECT_EQ(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
    return message;
  }
};

std::vector<LoggedMessage> readLog(const std::string& path) {
  std::vector<LoggedMessage> messages;
  lcm::LogFile log(path, "r");
  while (const lcm::LogEvent* event = log.readNextEvent()) {
    const auto* bytes = static_cast<const std::uint8_t*>(event->data);
    messages.push_back({event->channel, {bytes, bytes + event->datalen}});
  }
  return messages;
}

LcmOptions toFile(const std::string& path) {
  LcmOptions options;
  options.url = "file://" + path + "?mode=w";
  return options;
}

TEST(LcmPublisher, EveryFrameIsToldAndMeasuredOnesAsPoses) {
  const TemporaryFolder folder;
  const std::string log = folder.path("log");
  {
    LcmPublisher publisher(toFile(log), Pose());
    publisher.frame(frameWithoutPose(0, TrackingState::initialising, "waiting"));
    for (int i = 1; i < 4; ++i) {
      publisher.frame(measuredFrame(i, {Eigen::Quaterniond::Identity(), {0.1 * i, 0, 0}}));
    }
    publisher.frame(frameWithoutPose(4, TrackingState::lost, "dark"));
    EXPECT_TRUE(comesTrue([&] { return publisher.counts().sent == 19; }));
    EXPECT_EQ(publisher.counts().not_sent, 0);
    EXPECT_EQ(publisher.problem(), "");
    EXPECT_FALSE(publisher.nextCommand());
  }
  std::map<std::string, int> channels;
  std::int64_t sequence = 0;
  std::vector<std::uint8_t> statuses;
  for (const LoggedMessage& message : readLog(log)) {
    ++channels[message.channel];
    if (message.channel == "SLAM_STATE") {
      EXPECT_EQ(message.as<state_t>().sequence, sequence++);
    }
    if (message.channel == "SLAM_REL_ODOMETRY") statuses.push_back(message.as<update_t>().estimate_status);
  }
  EXPECT_EQ(channels, (std::map<std::string, int>{{"SLAM_CORRECTION", 3},
                                                  {"SLAM_ODOMETRY", 3},
                                                  {"SLAM_POSE", 3},
                                                  {"SLAM_REL_ODOMETRY", 5},
                                                  {"SLAM_STATE", 5}}));
  EXPECT_EQ(statuses, (std::vector<std::uint8_t>{0, 0, 1, 1, 2})) << "the first pose has none before it";
}

TEST(LcmPublisher, AMapBegunAnewHasNoMotionFromTheOldOne) {
  const TemporaryFolder folder;
  const std::string log = folder.path("log");
  {
    LcmPublisher publisher(toFile(log), Pose());
    publisher.frame(measuredFrame(0, {Eigen::Quaterniond::Identity(), {5, 0, 0}}));
    publisher.frame(frameWithoutPose(1, TrackingState::initialising, "reset"));
    publisher.frame(measuredFrame(2, Pose()));
  }
  std::vector<LoggedMessage> updates, corrections;
  for (const LoggedMessage& message : readLog(log)) {
    if (message.channel == "SLAM_REL_ODOMETRY") updates.push_back(message);
    if (message.channel == "SLAM_CORRECTION") corrections.push_back(message);
  }
  EXPECT_EQ(updates.back().as<update_t>().estimate_status, update_t::NO_DATA);
  EXPECT_EQ(corrections.back().as<correction_t>().reset_count, 1);
}

TEST(LcmPublisher, AMapGoesOutInPiecesBetweenTheFrames) {
  const TemporaryFolder folder;
  const std::string log = folder.path("log");
  const PublishedMap map{std::vector<PublishedPoint>(1000), std::vector<PublishedLine>(100)};
  {
    LcmPublisher publisher(toFile(log), Pose());
    publisher.map(1, map);  // given up for the next
    publisher.frame(measuredFrame(0, Pose()));
    publisher.map(2, map);
    for (int i = 1; i < 10; ++i) publisher.frame(measuredFrame(i, Pose()));
  }
  int point_parts = 0, line_parts = 0, since_state = 0;
  for (const LoggedMessage& message : readLog(log)) {
    if (message.channel == "SLAM_STATE") since_state = 0;
    if (message.channel == "SLAM_MAP") {
      const auto part = message.as<map_part_t>();
      EXPECT_LE(++since_state, 4);
      if (part.version == 1) continue;
      EXPECT_EQ(part.version, 2);
      EXPECT_EQ(line_parts, 3) << "lines go out first";
      EXPECT_EQ(part.part, point_parts++);
    }
    if (message.channel == "SLAM_MAP_LINES") {
      const auto part = message.as<map_lines_t>();
      EXPECT_LE(++since_state, 4);
      if (part.version == 1) continue;
      EXPECT_EQ(part.version, 2);
      EXPECT_EQ(part.part, line_parts++);
    }
  }
  EXPECT_EQ(point_parts, 25);
  EXPECT_EQ(line_parts, 3);
}

TEST(LcmPublisher, AMapWithoutAnythingIsToldToo) {
  const TemporaryFolder folder;
  const std::string log = folder.path("log");
  {
    LcmOptions options = toFile(log);
    options.map_lines_channel = "LINES";
    LcmPublisher publisher(options, Pose());
    publisher.frame(measuredFrame(0, Pose()));
    publisher.map(1, {});
    publisher.frame(measuredFrame(1, Pose()));
    publisher.frame(measuredFrame(2, Pose()));
  }
  std::map<std::string, int> channels;
  for (const LoggedMessage& message : readLog(log)) {
    ++channels[message.channel];
    if (message.channel == "SLAM_MAP") {
      EXPECT_EQ(message.as<map_part_t>().points_in_map, 0);
    }
    if (message.channel == "LINES") {
      EXPECT_EQ(message.as<map_lines_t>().lines_in_map, 0);
    }
  }
  EXPECT_EQ(channels["SLAM_MAP"], 1);
  EXPECT_EQ(channels["LINES"], 1);
}

TEST(LcmPublisher, AStatusTellsWhatWasSent) {
  const TemporaryFolder folder;
  const std::string log = folder.path("log");
  {
    LcmPublisher publisher(toFile(log), Pose());
    publisher.frame(measuredFrame(0, Pose()));
    ASSERT_TRUE(comesTrue([&] { return publisher.counts().sent == 5; }));
    PublisherStatus status;
    status.keyframes = 5;
    publisher.status(status);
    publisher.status(status);
  }
  const std::vector<LoggedMessage> messages = readLog(log);
  ASSERT_EQ(messages.size(), 7U);
  const auto first = messages[5].as<status_t>(), second = messages[6].as<status_t>();
  EXPECT_EQ(first.keyframes, 5);
  EXPECT_EQ(first.messages_sent, 5);
  EXPECT_EQ(first.latency_p50_ms, 12);
  EXPECT_EQ(second.sequence, 1);
  EXPECT_EQ(second.latency_p50_ms, -1);
}

TEST(LcmPublisher, WhatCannotBeSentIsCountedAndToldWhy) {
  LcmPublisher publisher(toFile("/no/such/folder/log"), Pose());
  for (int i = 0; i < 5; ++i) publisher.frame(measuredFrame(i, Pose()));
  EXPECT_TRUE(comesTrue([&] { return publisher.counts().not_sent == 25; }));
  EXPECT_EQ(publisher.counts().sent, 0);
  EXPECT_NE(publisher.problem().find("/no/such/folder/log"), std::string::npos);
}

TEST(LcmPublisher, BadOptionsAreRefused) {
  LcmOptions options;
  options.url = "udpm://nowhere";
  expectInputError([&] { LcmPublisher(options, Pose()); }, "no multicast group");
  options.url = "memq://";
  options.pose_channel = "";
  expectInputError([&] { LcmPublisher(options, Pose()); }, "LCM channel");
}

}  // namespace
}  // namespace edgeslam
