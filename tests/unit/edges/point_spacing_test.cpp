// P6: points very close to one another are told.
#include "edges/point_spacing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace edgeslam {
namespace {

TEST(PointSpacing, AgreesWithComparingAllPairs) {
  for (const double distance : {0.0, 1.5, 6.0, 40.0}) {
    PointSpacing spacing({100, 80}, distance);
    std::vector<Eigen::Vector2f> points;
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> uniform(-20, 120);  // some lie outside the image
    for (int trial = 0; trial < 500; ++trial) {
      const Eigen::Vector2f pixel(uniform(generator), uniform(generator));
      bool expected = true;
      for (const Eigen::Vector2f& point : points) {
        expected = expected && (point - pixel).squaredNorm() >= static_cast<float>(distance * distance);
      }
      ASSERT_EQ(spacing.isFree(pixel), expected);
      if (!expected) continue;
      spacing.add(pixel);
      points.push_back(pixel);
    }
  }
}

TEST(PointSpacing, IgnoresPointsThatAreNowhere) {
  PointSpacing spacing({100, 80}, 6);
  spacing.add({std::nanf(""), 4});
  spacing.add({INFINITY, 4});
  EXPECT_TRUE(spacing.isFree({99, 4}));
}

}  // namespace
}  // namespace edgeslam
