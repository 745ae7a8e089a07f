// Weights of errors, and parts of a recording.
#include "inertia/pose_errors.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

TEST(PoseErrors, PartsAreShortAndAtLeastAboutTwelve) {
  EXPECT_EQ(partLength(0, 60'000'000'000), 2'000'000'001);
  const std::int64_t part_ns = partLength(1000, 9'000'001'000);
  EXPECT_EQ(9'000'000'000 / part_ns, 11) << "the twelfth one begins there";
  EXPECT_GT(partLength(5, 5), 0);
}

TEST(PoseErrors, AnErrorOfFourMediansHasHalfTheWeight) {
  const std::vector<double> weights = cauchyWeights({1, 1, 4, 0, 1000});
  EXPECT_NEAR(weights[0], 16.0 / 17, 1e-12);
  EXPECT_NEAR(weights[2], 0.5, 1e-12);
  EXPECT_EQ(weights[3], 1);
  EXPECT_LT(weights[4], 1e-4);
  EXPECT_EQ(cauchyWeights({0, 0}), (std::vector<double>{1, 1}));
  EXPECT_TRUE(cauchyWeights({}).empty());
}

}  // namespace
}  // namespace edgeslam
