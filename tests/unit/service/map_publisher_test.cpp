#include "service/map_publisher.h"

#include <gtest/gtest.h>

#include "unit/map/made_map.h"

namespace edgeslam {
namespace {

TEST(PublishedMap, HasPointsAndPlacedLinesOfOneWorld) {
  SavedMap saved = test::madeMap(64, 48);
  const PublishedMap map = publishedMap(saved.map, 0, saved.camera);
  EXPECT_EQ(map.points.size(), 3U);
  ASSERT_EQ(map.lines.size(), 1U) << "the other one is not placed";
  EXPECT_EQ(map.lines[0].id, 3);
  EXPECT_NEAR((map.lines[0].to - map.lines[0].from).norm(), 0.1 + 1.0 / 3, 1e-6);

  test::keyframeOf(saved, 4).world = 1;  // which points and lines are hosted by
  EXPECT_TRUE(publishedMap(saved.map, 0, saved.camera).points.empty());
  EXPECT_TRUE(publishedMap(saved.map, 0, saved.camera).lines.empty());
  EXPECT_EQ(publishedMap(saved.map, 1, saved.camera).points.size(), 3U);
  EXPECT_EQ(publishedMap(saved.map, 1, saved.camera).lines.size(), 1U);
}

TEST(LargestWorld, IsThatOfMostKeyframes) {
  EXPECT_EQ(largestWorld(Map()), 0);
  EXPECT_EQ(largestWorld(test::madeMap(64, 48).map), 0);
}

}  // namespace
}  // namespace edgeslam
