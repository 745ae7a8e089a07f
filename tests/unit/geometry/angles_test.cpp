#include "geometry/angles.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

TEST(Angles, AFullTurnIsTwoPi) {
  EXPECT_DOUBLE_EQ(radians(360), 2 * M_PI);
  EXPECT_DOUBLE_EQ(degrees(M_PI / 2), 90);
  EXPECT_DOUBLE_EQ(degrees(radians(-12.5)), -12.5);
}

}  // namespace
}  // namespace edgeslam
