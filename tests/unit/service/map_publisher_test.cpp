#include "service/map_publisher.h"

#include <gtest/gtest.h>

#include "unit/map/made_map.h"

namespace edgeslam {
namespace {

TEST(LargestWorld, IsThatOfMostKeyframes) {
  EXPECT_EQ(largestWorld(Map()), 0);
  EXPECT_EQ(largestWorld(test::madeMap(64, 48).map), 0);
}

}  // namespace
}  // namespace edgeslam
