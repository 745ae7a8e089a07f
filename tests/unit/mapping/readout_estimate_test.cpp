#include "mapping/readout_estimate.h"

#include <gtest/gtest.h>

#include "unit/mapping/wrong_lens.h"

namespace edgeslam {
namespace {

TEST(ReadoutEstimate, IsThatWithWhichTheMapFits) {
  for (const double readout_s : {-0.025, 0.0, 0.012, 0.03}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const test::Walk walk = test::rollingWalk(seed, 20, readout_s, 0.5, 0.2);
      const auto estimate = estimateReadout(test::lookedAt(test::Walk::camera(), walk), 0.05);
      ASSERT_TRUE(estimate);
      EXPECT_NEAR(estimate->value, readout_s, 0.0015) << seed;
      EXPECT_GT(estimate->sigma, 0);
      EXPECT_LT(estimate->sigma, 0.001);
    }
  }
}

TEST(ReadoutEstimate, IsNoLongerThanTheFramesAreApart) {
  Map map = test::rollingWalk(1, 4, 0, 0.5, 0.2).map;
  EXPECT_EQ(longestReadout(map, test::allKeyframes(map)), 0.05);
  map.keyframes.back().time_ns = map.keyframes[2].time_ns + 33'000'000;
  EXPECT_NEAR(longestReadout(map, test::allKeyframes(map)), 0.033, 1e-9);
  map.keyframes[2].time_ns = map.keyframes[1].time_ns;
  EXPECT_GT(longestReadout(map, test::allKeyframes(map)), 0) << "two keyframes of one frame say nothing of it";
}

}  // namespace
}  // namespace edgeslam
