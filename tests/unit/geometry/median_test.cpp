#include "geometry/median.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace edgeslam {
namespace {

TEST(Median, IsTheMiddleValueOrTheLargerOfTheTwo) {
  EXPECT_EQ(median<double>({3, 1, 2}), 2);
  EXPECT_EQ(median<double>({4, 1, 3, 2}), 3);
  EXPECT_EQ(median<std::int64_t>({7}), 7);
}

TEST(Median, OfNoneIsTheFallback) {
  EXPECT_EQ(medianOr<double>(5, {}), 5);
  EXPECT_EQ(medianOr<double>(5, {1, 2}), 2);
}

}  // namespace
}  // namespace edgeslam
