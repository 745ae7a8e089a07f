// The map's messages, put together as the page does.
#include "drivers/viewer/viewed_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "drivers/viewer/view_messages.h"
#include "unit/map/made_map.h"

namespace edgeslam {
namespace {

class Reader {
 public:
  explicit Reader(const std::string& message) : message_(message) {
    EXPECT_EQ(static_cast<ViewMessage>(message.at(0)), ViewMessage::map);
    at_ = 1;
    const auto length = next<std::uint32_t>();
    description = nlohmann::json::parse(message.substr(at_, length));
    at_ += length;
  }
  template <typename Number>
  Number next() {
    Number number{};
    EXPECT_LE(at_ + sizeof(number), message_.size());
    std::memcpy(&number, message_.data() + at_, sizeof(number));
    at_ += sizeof(number);
    return number;
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> runs(const char* count) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found(description[count].get<std::size_t>());
    for (auto& [from, length] : found) {
      from = next<std::uint32_t>();
      length = next<std::uint32_t>();
    }
    return found;
  }
  bool isAtEnd() const { return at_ == message_.size(); }

  nlohmann::json description;

 private:
  const std::string& message_;
  std::size_t at_ = 0;
};

template <typename Item>
std::vector<Item> putTogether(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& runs,
                              const std::vector<Item>& before, const std::vector<Item>& added) {
  std::vector<Item> whole;
  std::size_t taken = 0;
  for (const auto& [from, length] : runs) {
    const bool is_new = from == 0xffffffff;
    const std::vector<Item>& source = is_new ? added : before;
    const std::size_t begin = is_new ? taken : from;
    EXPECT_LE(begin + length, source.size());
    whole.insert(whole.end(), source.begin() + static_cast<std::ptrdiff_t>(begin),
                 source.begin() + static_cast<std::ptrdiff_t>(begin + length));
    taken += is_new ? length : 0;
  }
  EXPECT_EQ(taken, added.size());
  return whole;
}

// What a client has that had `before`. Numbers of points and keyframes are not sent, and stay 0.
ViewedMap received(const std::string& message, const ViewedMap& before) {
  Reader reader(message);
  const auto point_runs = reader.runs("point_runs"), keyframe_runs = reader.runs("keyframe_runs");
  std::vector<ViewedPoint> points(reader.description["new_points"].get<std::size_t>());
  std::vector<ViewedKeyframe> keyframes(reader.description["new_keyframes"].get<std::size_t>());
  for (ViewedPoint& point : points) {
    for (float& coordinate : point.position) coordinate = reader.next<float>();
  }
  for (ViewedKeyframe& keyframe : keyframes) {
    for (float& number : keyframe.pose) number = reader.next<float>();
  }
  std::vector<ViewedLine> lines(reader.description["lines"].get<std::size_t>());
  for (ViewedLine& line : lines) {
    for (float& coordinate : line) coordinate = reader.next<float>();
  }
  for (ViewedPoint& point : points) point.grey = reader.next<std::uint8_t>();
  for (ViewedPoint& point : points) point.depth_sigma_percent = reader.next<std::uint8_t>();
  for (ViewedPoint& point : points) point.joined = reader.next<std::uint8_t>();
  EXPECT_TRUE(reader.isAtEnd());
  ViewedMap map;
  map.number = reader.description["number"];
  map.points = putTogether(point_runs, before.points, points);
  map.keyframes = putTogether(keyframe_runs, before.keyframes, keyframes);
  map.lines = lines;
  EXPECT_EQ(reader.description["points"], map.points.size());
  EXPECT_EQ(reader.description["keyframes"], map.keyframes.size());
  return map;
}

void expectSame(const ViewedMap& a, const ViewedMap& b) {
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    ASSERT_EQ(a.points[i].position, b.points[i].position) << i;
    ASSERT_EQ(a.points[i].grey, b.points[i].grey) << i;
    ASSERT_EQ(a.points[i].depth_sigma_percent, b.points[i].depth_sigma_percent) << i;
    ASSERT_EQ(a.points[i].joined, b.points[i].joined) << i;
  }
  ASSERT_EQ(a.keyframes.size(), b.keyframes.size());
  for (std::size_t i = 0; i < a.keyframes.size(); ++i) ASSERT_EQ(a.keyframes[i].pose, b.keyframes[i].pose) << i;
  ASSERT_EQ(a.lines, b.lines);
}

ViewedMap madeList(std::mt19937& random, int points, int keyframes) {
  ViewedMap map;
  const auto number = [&] { return static_cast<float>(random() % 1000) / 7; };
  for (int i = 0; i < points; ++i) {
    map.points.push_back({i, {number(), number(), number()}, static_cast<std::uint8_t>(i), 12, 1});
  }
  for (int i = 0; i < keyframes; ++i) map.keyframes.push_back({i, {number(), 0, 0, 0, 0, 0, 1}});
  for (int i = 0; i < std::min(keyframes, 2); ++i) map.lines.push_back({number(), 0, 0, number(), 1, 2});
  return map;
}

// Some points move, some go, some come, and some change their places.
ViewedMap changed(const ViewedMap& before, std::mt19937& random) {
  ViewedMap map = before;
  const auto share = [&](unsigned in_hundred) { return random() % 100 < in_hundred; };
  const unsigned often = random() % 60;
  for (ViewedPoint& point : map.points) {
    if (share(often)) point.position[0] += 1;
    if (share(1)) ++point.depth_sigma_percent;
  }
  map.points.erase(std::remove_if(map.points.begin(), map.points.end(), [&](const ViewedPoint&) { return share(5); }),
                   map.points.end());
  for (int i = 0; i < 10; ++i) {
    ViewedPoint added;
    added.id = static_cast<PointId>(100'000 + random() % 100'000);
    const auto place = static_cast<std::ptrdiff_t>(random() % (map.points.size() + 1));
    map.points.insert(map.points.begin() + place, added);
  }
  if (map.points.size() > 20 && share(50)) std::rotate(map.points.begin(), map.points.begin() + 10, map.points.end());
  map.keyframes.push_back({static_cast<KeyframeId>(1000 + random() % 1000), {1, 2, 3, 0, 0, 0, 1}});
  if (share(30)) map.keyframes.erase(map.keyframes.begin());
  return map;
}

TEST(ViewedMap, AClientHasTheMapWhateverItWasSentBefore) {
  std::mt19937 random(1);
  ViewedMap sent = madeList(random, 300, 8), has;
  sent.number = 1;
  has = received(mapMessage(sent, nullptr), {});
  expectSame(has, sent);
  for (int round = 0; round < 50; ++round) {
    ViewedMap now = changed(sent, random);
    if (round % 3 == 0) now = changed(now, random);  // it was too slow for the one between
    now.number = sent.number + 1;
    has = received(mapMessage(now, &sent), has);
    expectSame(has, now);
    sent = now;
  }
  const ViewedMap empty;
  expectSame(received(mapMessage(empty, &sent), has), empty);
}

TEST(ViewedMap, OnlyWhatChangedIsSent) {
  std::mt19937 random(2);
  ViewedMap before = madeList(random, 20000, 200), now = before;
  before.number = 7;
  now.number = 8;
  for (std::size_t i = 500; i < 900; ++i) now.points[i].position[2] += 0.01F;
  now.keyframes.back().pose[0] += 1;
  now.points.erase(now.points.begin() + 3);
  const std::string whole = mapMessage(now, nullptr), part = mapMessage(now, &before);
  EXPECT_LT(part.size(), whole.size() / 30);
  Reader reader(part);
  EXPECT_EQ(reader.description["after"], 7);
  EXPECT_EQ(reader.description["new_points"], 400);
  EXPECT_EQ(reader.description["new_keyframes"], 1);
  EXPECT_EQ(Reader(whole).description["after"], 0);
  EXPECT_LT(mapMessage(before, &before).size(), 400U) << "nothing changed";
}

TEST(ViewedMap, HasItsPointsAndKeyframes) {
  SavedMap saved = test::madeMap(64, 48);
  for (auto& [id, point] : saved.map.points) point.inverse_depth = std::abs(point.inverse_depth) + 0.1;
  const ViewedMap map = viewedMap(saved.map, 0, saved.camera, 1);
  EXPECT_EQ(map.points.size(), saved.map.points.size());
  EXPECT_EQ(map.points_in_map, saved.map.points.size());
  ASSERT_EQ(map.keyframes.size(), 4U);
  ASSERT_EQ(map.lines.size(), 1U) << "the other line is not placed";
  const SpaceLine line = inWorld(saved.map, saved.map.lines.at(3));
  EXPECT_FLOAT_EQ(map.lines[0][3], static_cast<float>((line.point + line.direction / 3).x()));
  for (const ViewedPoint& point : map.points) {
    for (const float coordinate : point.position) EXPECT_TRUE(std::isfinite(coordinate));
  }
  EXPECT_EQ(map.points.front().joined, 0) << "nothing comes before the first point";
  const Pose& first = saved.map.keyframes.atPlace(0).world_T_camera;
  EXPECT_FLOAT_EQ(map.keyframes[0].pose[0], static_cast<float>(first.translation.x()));
  EXPECT_FLOAT_EQ(map.keyframes[0].pose[6], static_cast<float>(first.rotation.w()));
}

TEST(ViewedMap, ShowsOneWorldAlone) {
  const SavedMap saved = test::madeMap(64, 48);
  const ViewedMap other = viewedMap(saved.map, 7, saved.camera, 1);
  EXPECT_TRUE(other.points.empty());
  EXPECT_TRUE(other.keyframes.empty());
  EXPECT_TRUE(other.lines.empty());
  EXPECT_EQ(other.points_in_map, 0U);
  EXPECT_EQ(Reader(mapMessage(other, nullptr)).description["world"], 7);
}

TEST(ViewedMap, AnEmptyMapAndAHugeOneAreBoundedAndGrowthLeavesTheShownOnesThere) {
  const ViewedMap empty = viewedMap(Map(), 0, Camera(), 1);
  EXPECT_TRUE(empty.points.empty());
  EXPECT_TRUE(received(mapMessage(empty, nullptr), {}).points.empty());

  SavedMap saved = test::madeMap(64, 48);
  MapPoint point = saved.map.points.begin()->second;
  saved.map.points.clear();
  const auto grow = [&](PointId from, PointId to) {
    for (PointId id = from; id < to; ++id) {
      point.id = id;
      point.chain = static_cast<int>(id / 30);
      point.order = static_cast<int>(id % 30);
      point.inverse_depth = id % 1000 == 0 ? 0 : 0.5;  // infinitely far
      saved.map.points[id] = point;
    }
  };
  grow(0, 45000);
  const ViewedMap huge = viewedMap(saved.map, 0, saved.camera, 1);
  EXPECT_LE(huge.points.size(), most_viewed_points);
  EXPECT_GT(huge.points.size(), most_viewed_points - 10);
  EXPECT_EQ(huge.points_in_map, 45000U);
  for (const ViewedPoint& viewed : huge.points) ASSERT_TRUE(std::isfinite(viewed.position[0]));
  int of_first_half = 0;
  for (const ViewedPoint& viewed : huge.points) of_first_half += viewed.id < 22500;
  EXPECT_NEAR(of_first_half, 10000, 500) << "spread evenly";

  grow(45000, 46000);
  const ViewedMap larger = viewedMap(saved.map, 0, saved.camera, 2);
  Reader reader(mapMessage(larger, &huge));
  EXPECT_LT(reader.description["new_points"].get<int>(), 2000);
}

}  // namespace
}  // namespace edgeslam
