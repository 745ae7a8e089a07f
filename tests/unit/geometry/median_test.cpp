#include "geometry/median.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace edgeslam {
namespace {

TEST(Median, IsTheMiddleValueOrTheLargerOfTheTwo) {
  EXPECT_EQ(upperMedian(std::vector<double>{3, 1, 2}), 2);
  EXPECT_EQ(upperMedian(std::vector<double>{4, 1, 3, 2}), 3);
  EXPECT_EQ(upperMedian(std::vector<std::int64_t>{7}), 7);
}

TEST(Median, OfNoneIsTheFallback) {
  EXPECT_EQ(medianOr(5.0, std::vector<double>{}), 5);
  EXPECT_EQ(medianOr(5.0, std::vector<double>{1, 2}), 2);
}

}  // namespace
}  // namespace edgeslam
