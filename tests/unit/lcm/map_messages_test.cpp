#include "drivers/lcm/map_messages.h"

#include <gtest/gtest.h>

#include <limits>

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

TEST(MapMessages, PartsTogetherAreTheMap) {
  for (const std::size_t count : {0U, 1U, 39U, 40U, 41U, 80U, 1003U}) {
    const std::vector<PublishedPoint> points = madePoints(count);
    const int parts = numberOfMapParts(count);
    std::size_t at = 0;
    for (int part = 0; part < parts; ++part) {
      const map_part_t message = mapPart(points, part, 9, 77, {ScaleKind::known_distance, 2, 0});
      EXPECT_EQ(message.version, 9);
      EXPECT_EQ(message.part, part);
      EXPECT_EQ(message.parts, parts);
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

TEST(MapMessages, APartFitsIntoAPacket) { EXPECT_LT(map_part_t().getEncodedSize(), 1400 - 72); }

TEST(MapMessages, PointsThatAreNotFiniteAreLeftOut) {
  std::vector<PublishedPoint> points = madePoints(3);
  points[1].position.z() = std::numeric_limits<float>::quiet_NaN();
  points[2].direction.x() = std::numeric_limits<float>::infinity();
  const std::vector<PublishedPoint> finite = finitePoints(points);
  ASSERT_EQ(finite.size(), 1U);
  EXPECT_EQ(finite[0].id, 1);
}

}  // namespace
}  // namespace edgeslam
