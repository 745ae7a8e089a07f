#include "drivers/lcm/map_messages.h"

#include <gtest/gtest.h>

#include <limits>

#include "drivers/lcm/messages.h"

namespace edgeslam {
namespace {

std::vector<PublishedPoint> madePoints(std::size_t count) {
  std::vector<PublishedPoint> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    points[i].id = static_cast<PointId>(3 * i + 1);
    points[i].position = Eigen::Vector3f(static_cast<float>(i), 1, 2);
    if (i % 2) points[i].direction = Eigen::Vector3f::UnitX();
  }
  return points;
}

std::vector<PublishedLine> madeLines(std::size_t count) {
  std::vector<PublishedLine> lines(count);
  for (std::size_t i = 0; i < count; ++i) {
    lines[i].id = static_cast<LineId>(2 * i + 5);
    lines[i].from = Eigen::Vector3f(static_cast<float>(i), 1, 2);
    lines[i].to = Eigen::Vector3f(3, 4, -static_cast<float>(i));
  }
  return lines;
}

// What parts of points and of lines share.
template <class Message>
void expectPart(const Message& message, int part, int parts) {
  EXPECT_EQ(message.utime, 77);
  EXPECT_EQ(message.version, 9);
  EXPECT_EQ(message.part, part);
  EXPECT_EQ(message.parts, parts);
  EXPECT_EQ(message.scale_state, state_t::SCALE_FROM_KNOWN_DISTANCE);
}

TEST(MapMessages, PartsTogetherAreTheMap) {
  for (const std::size_t count : {0U, 1U, 39U, 40U, 41U, 80U, 1003U}) {
    const std::vector<PublishedPoint> points = madePoints(count);
    const int parts = numberOfPointParts(count);
    std::size_t at = 0;
    for (int part = 0; part < parts; ++part) {
      const map_part_t message = pointPart(points, part, 9, 77, {Pose(), {ScaleKind::known_distance, 2, 0}});
      expectPart(message, part, parts);
      EXPECT_EQ(message.points_in_map, static_cast<int>(count));
      ASSERT_LE(message.points, map_part_t::MOST_POINTS);
      if (count > 0) {
        EXPECT_GT(message.points, 0);
      }
      for (int i = 0; i < message.points; ++i, ++at) {
        ASSERT_LT(at, count);
        EXPECT_EQ(message.id[i], points[at].id);
        EXPECT_EQ(message.position[i][0], 2 * points[at].position.x());
        EXPECT_EQ(message.direction[i][0], points[at].direction.x());
      }
      for (int i = message.points; i < map_part_t::MOST_POINTS; ++i) EXPECT_EQ(message.id[i], 0);
    }
    EXPECT_EQ(at, count);
  }
}

TEST(MapMessages, PartsTogetherAreTheLines) {
  for (const std::size_t count : {0U, 1U, 39U, 40U, 41U, 80U, 503U}) {
    const std::vector<PublishedLine> lines = madeLines(count);
    const int parts = numberOfLineParts(count);
    std::size_t at = 0;
    for (int part = 0; part < parts; ++part) {
      const map_lines_t message = linePart(lines, part, 9, 77, {Pose(), {ScaleKind::known_distance, 2, 0}});
      expectPart(message, part, parts);
      EXPECT_EQ(message.lines_in_map, static_cast<int>(count));
      ASSERT_LE(message.lines, map_lines_t::MOST_LINES);
      if (count > 0) {
        EXPECT_GT(message.lines, 0);
      }
      for (int i = 0; i < message.lines; ++i, ++at) {
        ASSERT_LT(at, count);
        EXPECT_EQ(message.id[i], lines[at].id);
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_EQ(message.first_end[i][axis], 2 * lines[at].from[axis]);
          EXPECT_EQ(message.second_end[i][axis], 2 * lines[at].to[axis]);
        }
      }
      for (int i = message.lines; i < map_lines_t::MOST_LINES; ++i) EXPECT_EQ(message.id[i], 0);
    }
    EXPECT_EQ(at, count);
  }
}

TEST(MapMessages, WithoutAnyThereIsOnePartThatSaysSo) {
  EXPECT_EQ(numberOfPointParts(0), 1);
  EXPECT_EQ(numberOfLineParts(0), 1);
}

TEST(MapMessages, APartFitsIntoAPacket) {
  EXPECT_LT(map_part_t().getEncodedSize(), 1400 - 72);
  EXPECT_LT(map_lines_t().getEncodedSize(), 1400 - 72);
}

TEST(MapMessages, WhatIsNotFiniteIsLeftOut) {
  PublishedMap map{madePoints(3), madeLines(3)};
  map.points[1].position.z() = std::numeric_limits<float>::quiet_NaN();
  map.points[2].direction.x() = std::numeric_limits<float>::infinity();
  map.lines[0].from.y() = std::numeric_limits<float>::infinity();
  map.lines[2].to.x() = std::numeric_limits<float>::quiet_NaN();
  const PublishedMap finite = finiteMap(map);
  ASSERT_EQ(finite.points.size(), 1U);
  EXPECT_EQ(finite.points[0].id, 1);
  ASSERT_EQ(finite.lines.size(), 1U);
  EXPECT_EQ(finite.lines[0].id, 7);
}

}  // namespace
}  // namespace edgeslam
