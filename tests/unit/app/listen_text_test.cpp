#include "app/listen_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "drivers/lcm/messages.h"
#include "edgeslam/command_answer_t.hpp"
#include "edgeslam/command_t.hpp"
#include "edgeslam/map_lines_t.hpp"
#include "edgeslam/map_part_t.hpp"
#include "edgeslam/status_t.hpp"
#include "unit/lcm/encoded_message.h"
#include "unit/lcm/made_frames.h"

namespace edgeslam {
namespace {

std::string describe(const std::vector<std::uint8_t>& bytes) { return describeMessage(bytes.data(), bytes.size()); }

state_t stateOf(const FrameResult& frame, std::int64_t sequence) {
  return frameMessages(frame, {}, std::nullopt, sequence, 0).state;
}

bool printable(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

std::vector<std::vector<std::uint8_t>> oneOfEach() {
  const LcmFrame frame = frameMessages(measuredFrame(3, Pose()), {}, std::nullopt, 3, 0);
  status_t status{};
  status.reason = "x";
  return {encoded(*frame.pose),  encoded(frame.state),   encoded(frame.update), encoded(status),
          encoded(map_part_t{}), encoded(map_lines_t{}), encoded(command_t{}),  encoded(command_answer_t{})};
}

TEST(ListenText, AStateIsTold) {
  const std::string lost = describe(encoded(stateOf(frameWithoutPose(3, TrackingState::lost, "dark"), 9)));
  EXPECT_NE(lost.find("#9 t 5.099999 s"), std::string::npos) << lost;
  EXPECT_NE(lost.find("lost: dark"), std::string::npos) << lost;
  EXPECT_EQ(lost.find(" at "), std::string::npos) << lost;
  const std::string tracked = describe(encoded(stateOf(measuredFrame(3, {{1, 0, 0, 0}, {1, 2, 3}}), 9)));
  EXPECT_NE(tracked.find("tracking, world 0, at 1.000 2.000 3.000"), std::string::npos) << tracked;
  EXPECT_NE(tracked.find("scale unknown"), std::string::npos) << tracked;
}

TEST(ListenText, PartsOfAMapAreTold) {
  map_part_t points{};
  points.version = 3, points.part = 1, points.parts = 2, points.points = 4, points.points_in_map = 44;
  EXPECT_EQ(describe(encoded(points)), "version 3, part 2 of 2, 4 of 44 points");
  map_lines_t lines{};
  lines.version = 3, lines.parts = 1, lines.lines = lines.lines_in_map = 7;
  EXPECT_EQ(describe(encoded(lines)), "version 3, part 1 of 1, 7 of 7 lines");
}

TEST(ListenText, EveryTypeIsKnownByItsHash) {
  for (const auto& bytes : oneOfEach()) {
    const std::string text = describe(bytes);
    EXPECT_EQ(text.find("not ours"), std::string::npos) << text;
    EXPECT_EQ(text.find("malformed"), std::string::npos) << text;
  }
  EXPECT_EQ(describe({1, 2, 3}), "3 bytes of a type that is not ours");
  EXPECT_EQ(describe({}), "0 bytes of a type that is not ours");
}

TEST(ListenText, HostileBytesAreOneCleanLine) {
  Random random(1);
  for (const auto& good : oneOfEach()) {
    for (std::size_t length = 8; length < good.size(); ++length) {
      EXPECT_NE(describe({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)}).find("malformed"),
                std::string::npos);
    }
    for (int i = 0; i < 300; ++i) {
      std::vector<std::uint8_t> noise = good;
      for (std::size_t byte = 8; byte < noise.size(); ++byte) {
        if (i % 2 == 0 || random.uniform(0, 1) < 0.05) noise[byte] = static_cast<std::uint8_t>(random.uniform(0, 256));
      }
      EXPECT_TRUE(printable(describe(noise)));
    }
  }
}

TEST(ListenText, NegativeAndZeroStringLengthsAreMalformed) {
  const std::vector<std::uint8_t> good = encoded(stateOf(measuredFrame(0, Pose()), 0));
  const std::size_t length_at = 8 + 3 * 8 + 1;
  for (const std::uint8_t byte : {0x00, 0x80, 0xff}) {
    std::vector<std::uint8_t> bad = good;
    std::fill_n(bad.begin() + length_at, 4, byte);
    EXPECT_NE(describe(bad).find("malformed"), std::string::npos) << int{byte};
  }
}

TEST(GapWatch, CountsWhatIsMissing) {
  GapWatch watch;
  const auto add = [&](const std::string& channel, std::int64_t sequence) {
    const auto bytes = encoded(stateOf(measuredFrame(0, Pose()), sequence));
    return watch.add(channel, bytes.data(), bytes.size());
  };
  EXPECT_EQ(add("A", 7), "") << "who comes late has lost nothing";
  EXPECT_EQ(add("A", 8), "");
  EXPECT_EQ(add("B", 1), "") << "each channel by itself";
  EXPECT_EQ(add("A", 12), "3 lost before this");
  EXPECT_EQ(add("A", 13), "");
  EXPECT_NE(add("A", 0).find("anew"), std::string::npos);
  EXPECT_EQ(add("A", 1), "");
  EXPECT_EQ(watch.lost(), 3);
  const auto pose = encoded(pose_t{});
  EXPECT_EQ(watch.add("A", pose.data(), pose.size()), "") << "has no number";
}

TEST(RateWatch, IsByChannelAndBeginsAnew) {
  RateWatch watch;
  EXPECT_EQ(watch.take(1), "nothing");
  for (int i = 0; i < 30; ++i) watch.add("SLAM_POSE");
  watch.add("SLAM_STATUS");
  EXPECT_EQ(watch.take(2), "SLAM_POSE 15.0/s, SLAM_STATUS 0.5/s");
  EXPECT_EQ(watch.take(1), "SLAM_POSE 0.0/s, SLAM_STATUS 0.0/s");
}

}  // namespace
}  // namespace edgeslam
