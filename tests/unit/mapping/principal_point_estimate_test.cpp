#include "mapping/principal_point_estimate.h"

#include <gtest/gtest.h>

#include "unit/mapping/wrong_lens.h"

namespace edgeslam {
namespace {

TEST(PrincipalPointEstimate, SaysHowFarItIsOff) {
  for (const Eigen::Vector2d& off : {Eigen::Vector2d(4, -3), Eigen::Vector2d(-3, 0), Eigen::Vector2d(0, 0)}) {
    const Camera wrong = test::withPrincipalPointMoved(test::Walk::camera(), off);
    const LookedAt at = test::lookedAt(wrong, test::mappedWith(wrong, 12, test::roll_that_tells));
    const auto estimate = estimatePrincipalPoint(at);
    ASSERT_TRUE(estimate);
    EXPECT_LT((estimate->change + off).norm(), 0.8) << off.transpose();
    EXPECT_GT(estimate->sigma, 0);
    EXPECT_LT(estimate->sigma, 0.5);
    EXPECT_GE(estimate->gain, 0);
    EXPECT_EQ(estimatePrincipalPoint(at, 30).has_value(), off.norm() > 1) << "where more is asked for";
    if (off.norm() < 1) continue;
    EXPECT_LT((worthwhile(at, *estimate) + off).norm(), 0.8) << off.transpose();
  }
}

}  // namespace
}  // namespace edgeslam
