// The publisher against subscribers by Fast DDS.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "drivers/lcm/clocks.h"
#include "drivers/ros2/ros2_publisher.h"
#include "system/lcm/background_process.h"
#include "system/lcm/own_network.h"
#include "system/ros2/fast_dds.h"
#include "unit/lcm/made_frames.h"

namespace edgeslam {
namespace {

// Of a robot that drives ahead by a millimetre a frame. The time stamp numbers the frames.
SentFrame sentFrame(int index) {
  SentFrame sent{};
  sent.frame.state.has_pose = true;
  sent.frame.state.utime = monotonicUtime();
  sent.frame.state.scale_state = state_t::SCALE_FROM_KNOWN_DISTANCE;
  sent.frame.state.position[0] = 0.001 * index;
  sent.frame.state.orientation[0] = 1;
  sent.frame.pose.emplace();
  sent.odometry.emplace();
  sent.odometry->odometry.pos[0] = 0.001 * index;
  sent.odometry->odometry.orientation[0] = 1;
  sent.odometry->correction.rotation[0] = 1;
  return sent;
}

PublishedMap largeMap() {
  PublishedMap map;
  map.points.resize(40000);
  for (std::size_t i = 0; i < map.points.size(); ++i) map.points[i].position = {0.001F * static_cast<float>(i), 2, 3};
  return map;
}

void pause(int microseconds) { std::this_thread::sleep_for(std::chrono::microseconds(microseconds)); }

// What was sent before a subscriber was found is not missed.
template <typename Message>
bool hearsSomething(Ros2Publisher& publisher, const FastDdsReader<Message>& reader) {
  return comesTrue([&] {
    publisher.frame(sentFrame(-1));
    return reader.count() > 0;
  });
}

template <typename Predicate>
std::string eventThat(Ros2Publisher& publisher, const Predicate& isMeant) {
  std::string found;
  comesTrue([&] {
    while (const std::optional<std::string> event = publisher.nextEvent()) {
      if (isMeant(*event)) found = *event;
    }
    return !found.empty();
  });
  return found;
}

auto contains(const std::string& text) {
  return [text](const std::string& event) { return event.find(text) != std::string::npos; };
}

// Frames 0 to count - 1 of those that were heard, each once, in order.
void expectAll(const std::vector<decoded::Odometry>& heard, int count) {
  std::vector<double> positions;
  for (const decoded::Odometry& odometry : heard) {
    if (odometry.position[0] >= 0) positions.push_back(odometry.position[0]);
  }
  ASSERT_EQ(positions.size(), static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) ASSERT_DOUBLE_EQ(positions[static_cast<std::size_t>(i)], 0.001 * i);
}

class Ros2Network : public OwnNetwork {
 protected:
  void SetUp() override {
    unsetenv("ROS_DOMAIN_ID");
    unsetenv("ROS_LOCALHOST_ONLY");
    unsetenv("CYCLONEDDS_URI");
    OwnNetwork::SetUp();
  }
};

TEST_F(Ros2Network, ASubscriberHearsEveryOneOfTenThousand) {
  constexpr int count = 10000;
  FastDdsParticipant participant;
  const FastDdsReader<decoded::Odometry> reader(participant, "rt/odom");
  Ros2Publisher publisher({}, 0);
  ASSERT_TRUE(hearsSomething(publisher, reader));
  for (int i = 0; i < count; ++i) {
    publisher.frame(sentFrame(i));
    pause(500);
  }
  EXPECT_TRUE(comesTrue([&] { return reader.heard().back().position[0] >= 0.001 * (count - 1); }));
  expectAll(reader.heard(), count);
  EXPECT_EQ(reader.wrong(), 0);
  EXPECT_EQ(reader.mismatches(), 0);
}

TEST_F(Ros2Network, TopicsAreInTheNamespaceAndOnTheDomain) {
  Ros2Options options;
  options.topic_namespace = "fleet/robot1";
  options.domain = 42;
  FastDdsParticipant participant(42), another(43);
  const FastDdsReader<decoded::Pose> reader(participant, "rt/fleet/robot1/pose"),
      elsewhere(another, "rt/fleet/robot1/pose");
  Ros2Publisher publisher(options, 0);
  ASSERT_TRUE(hearsSomething(publisher, reader));
  EXPECT_EQ(reader.heard().front().header.frame_id, "map");
  EXPECT_EQ(elsewhere.publishers(), 0);
}

TEST_F(Ros2Network, WhoComesLateGetsTheMap) {
  FastDdsParticipant participant;
  const FastDdsReader<decoded::Odometry> odometry(participant, "rt/odom");
  Ros2Publisher publisher({}, 0);
  ASSERT_TRUE(hearsSomething(publisher, odometry));
  const PublishedMap map = largeMap();
  publisher.map(map, 0, {});
  publisher.frame(sentFrame(1));
  ASSERT_TRUE(comesTrue([&] { return odometry.heard().back().position[0] > 0; })) << "the map is out before it";

  const FastDdsReader<decoded::Cloud> late(participant, "rt/map_points", {/*is_transient_local=*/true, 1});
  ASSERT_TRUE(comesTrue([&] { return late.count() > 0; }));
  const decoded::Cloud cloud = late.heard().front();
  EXPECT_EQ(cloud.width, map.points.size());
  ASSERT_EQ(cloud.data.size(), 12 * map.points.size());
  EXPECT_EQ(std::memcmp(cloud.data.data() + 12 * 39999, map.points.back().position.data(), 12), 0);
}

TEST_F(Ros2Network, ASubscriberThatStopsReadingDelaysNobody) {
  BackgroundProcess stopped({EDGESLAM_ROS2_LATENCY, "receive", "100000"});
  ASSERT_TRUE(stopped.says("ready"));
  FastDdsParticipant participant;
  const FastDdsReader<decoded::Odometry> reader(participant, "rt/odom");
  const FastDdsReader<decoded::Cloud> clouds(participant, "rt/map_points", {true, 1});
  Ros2Publisher publisher({}, 0);
  ASSERT_TRUE(hearsSomething(publisher, reader));
  pause(2'000'000);  // the other one is found, too
  stopped.freeze();
  constexpr int count = 3000;
  const PublishedMap map = largeMap();
  for (int i = 0; i < count; ++i) {
    publisher.frame(sentFrame(i));
    if (i % 500 == 0) publisher.map(map, 0, {});
    pause(1000);
  }
  EXPECT_TRUE(comesTrue([&] { return reader.heard().back().position[0] >= 0.001 * (count - 1); }));
  expectAll(reader.heard(), count);
  EXPECT_TRUE(comesTrue([&] { return clouds.count() > 0; }));
}

TEST_F(Ros2Network, TwoProgramsOnOneDomainAreToldOnce) {
  Ros2Publisher first({}, 0);
  ASSERT_NE(eventThat(first, contains("messages go out")), "");
  Ros2Publisher second({}, 0);
  const std::string told = eventThat(second, contains("another program publishes /odom"));
  EXPECT_NE(told.find("ros2.namespace"), std::string::npos) << told;
  int times = 0;
  for (int i = 0; i < 30; ++i) {
    second.frame(sentFrame(i));
    pause(100'000);
    while (const std::optional<std::string> event = second.nextEvent()) times += contains("/odom")(*event) ? 1 : 0;
  }
  EXPECT_EQ(times, 0);
}

TEST_F(Ros2Network, WithoutANetworkItIsToldAndTriedAnew) {
  ASSERT_TRUE(switchNetworkOff());
  Ros2Publisher publisher({}, 0);
  const std::string told = eventThat(publisher, contains("do not go out"));
  EXPECT_NE(told.find("tried anew"), std::string::npos) << told;
  EXPECT_EQ(told.find('\n'), std::string::npos);
  ASSERT_TRUE(switchNetworkOn());
  FastDdsParticipant participant;
  const FastDdsReader<decoded::Odometry> reader(participant, "rt/odom");
  EXPECT_TRUE(hearsSomething(publisher, reader));
  EXPECT_NE(eventThat(publisher, contains("messages go out on domain 0")), "");
}

// Another node has odom -> base_link, with its own drift: what we send goes together with that.
TEST_F(Ros2Network, MapToOdomGoesTogetherWithTheOtherNodesOdometry) {
  Ros2Options options;
  options.transforms = "map_to_odom";
  FastDdsParticipant participant;
  const FastDdsReader<decoded::Transforms> reader(participant, "rt/tf", {false, 1000});
  FastDdsTransforms other(participant);
  Ros2Publisher publisher(options, 0);
  ASSERT_TRUE(comesTrue([&] { return other.subscribers() > 1; })) << "our reader, and the one of this test";

  const auto mapToOdom = [&] {
    std::vector<decoded::Transform> found;
    for (const decoded::Transforms& message : reader.heard()) {
      for (const decoded::Transform& transform : message.transforms) {
        if (transform.child_frame_id == "odom") found.push_back(transform);
      }
    }
    return found;
  };
  // It is at x = 5 m + 1 m/s * t by the other's count, and at 0.001 m * i by ours.
  const std::int64_t start_us = realUtime();
  int frames = 0;
  ASSERT_TRUE(comesTrue([&] {
    SentFrame sent = sentFrame(frames++);
    publisher.frame(sent);
    pause(20'000);
    const std::int64_t now_us = realUtime();
    decoded::Transform transform;
    transform.header.sec = static_cast<std::int32_t>(now_us / 1'000'000);
    transform.header.nanosec = static_cast<std::uint32_t>(1000 * (now_us % 1'000'000));
    transform.header.frame_id = "odom";
    transform.child_frame_id = "base_link";
    transform.translation[0] = 5 + 1e-6 * static_cast<double>(now_us - start_us);
    transform.rotation[3] = 1;
    other.send({{transform}});
    return mapToOdom().size() >= 20;
  }));
  double last = -1;
  for (const decoded::Transform& transform : mapToOdom()) {
    const double other_x = 5 + 1e-9 * static_cast<double>(transform.header.stamp_ns() - 1000 * start_us);
    const double our_x = transform.translation[0] + other_x;  // of the body, in the map
    EXPECT_NEAR(our_x / 0.001, std::round(our_x / 0.001), 0.01) << "it is where one of our frames says";
    EXPECT_GT(our_x, last);
    last = our_x;
    EXPECT_EQ(transform.header.frame_id, "map");
  }
  for (const decoded::Transforms& message : reader.heard()) {
    for (const decoded::Transform& transform : message.transforms) {
      EXPECT_TRUE(transform.child_frame_id == "odom" || transform.translation[0] >= 5)
          << "ours of the body is not sent";
    }
  }
}

}  // namespace
}  // namespace edgeslam
