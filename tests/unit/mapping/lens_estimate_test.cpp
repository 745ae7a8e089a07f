#include "mapping/lens_estimate.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "unit/mapping/wrong_lens.h"

namespace edgeslam {
namespace {

using test::lookedAt;
using test::mappedWith;
using test::Walk;
using test::withDistortion;
using test::withFocalLengths;

TEST(LensEstimate, TheFocalLengthIsThatWithWhichTheMapFits) {
  for (const double times : {0.92, 1.0, 1.06}) {
    const Camera wrong = withFocalLengths(Walk::camera(), times);
    const auto equations = lensEquations(lookedAt(wrong, mappedWith(wrong, 3)));
    ASSERT_TRUE(equations);
    EXPECT_NEAR(estimateLens(*equations, true, false).change(0), -std::log(times), 0.01);
    EXPECT_TRUE(estimateLens(*equations, true, false).change.tail<2>().isZero(0));
  }
}

// One look says where to go; how far, the looks after it.
TEST(LensEstimate, TheDistortionThatIsFoundMakesUpForMostOfWhatTheWrongOneCosts) {
  for (const double more : {-0.01, 0.01}) {
    const Camera wrong = withDistortion(Walk::camera(), more);
    const LookedAt at = lookedAt(wrong, mappedWith(wrong, 3));
    const auto equations = lensEquations(at);
    ASSERT_TRUE(equations);
    const double of_right = costWith(at, Walk::camera());
    ASSERT_LT(of_right, 0.9 * at.cost);
    for (const bool focal_length : {false, true}) {
      const LensEstimate estimate = estimateLens(*equations, focal_length, true);
      const FoundCamera found = withLens(wrong, {}, estimate.change);
      EXPECT_LT(costWith(at, withFound(wrong, found)), of_right + 0.5 * (at.cost - of_right)) << more;
    }
  }
}

TEST(LensEstimate, TheRightLensStays) {
  const LensEstimate estimate =
      estimateLens(lensEquations(lookedAt(Walk::camera(), mappedWith(Walk::camera(), 3))).value(), true, true);
  EXPECT_NEAR(estimate.change(0), 0, 0.01);
  EXPECT_LT(estimate.change.tail<2>().norm(), 0.001);
}

TEST(LensEstimate, MoreThatIsFreeFitsNoWorseAndIsKnownNoBetter) {
  const Camera wrong = withDistortion(withFocalLengths(Walk::camera(), 1.05), 0.05);
  const auto equations = lensEquations(lookedAt(wrong, mappedWith(wrong, 11)));
  ASSERT_TRUE(equations);
  const LensEstimate both = estimateLens(*equations, true, true);
  for (const bool focal_length : {false, true}) {
    const LensEstimate one = estimateLens(*equations, focal_length, !focal_length);
    EXPECT_GT(both.gain, one.gain);
    EXPECT_GT(one.gain, 0);
    const int free = focal_length ? 0 : 1;
    EXPECT_GE(both.covariance(free, free), one.covariance(free, free));
  }
}

TEST(LensEstimate, WhereNothingExplainsMuchEachIsTakenByItself) {
  const Camera right = Walk::camera();
  const LookedAt at = lookedAt(right, mappedWith(right, 7));
  const auto all = lensEquations(at), alone = lensEquations(at, 1e6 * at.cost);
  ASSERT_TRUE(all && alone);
  EXPECT_EQ(alone->gradient, all->gradient);
  EXPECT_EQ(alone->information.diagonal(), all->information.diagonal());
  EXPECT_TRUE(alone->information.isDiagonal());
  EXPECT_FALSE(all->information.isDiagonal());
}

TEST(LensEstimate, WhatChangesDoTogetherLeavesEachAShareOfItsOwn) {
  Eigen::Matrix3d apart, alike;
  apart << 4, 1, 0, 1, 9, -2, 0, -2, 16;
  alike << 4, 7, 0, 7, 9, -2, 0, -2, 16;  // one direction has less than no information
  EXPECT_TRUE(wellConditioned(apart).isApprox(apart, 1e-12));
  const Eigen::Matrix3d mended = wellConditioned(alike);
  EXPECT_TRUE(mended.diagonal().isApprox(alike.diagonal(), 1e-12));
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(mended).eigenvalues()(0), 0.03 * 4 * 0.9);
  EXPECT_GT(mended(0, 1), 0);
  EXPECT_LT(mended(0, 1), 6);
}

TEST(LensEstimate, AChangeIsWorthwhileAsFarAsItTakesOffWhatIsExpected) {
  const Camera wrong = withDistortion(Walk::camera(), 0.015);
  const LookedAt at = lookedAt(wrong, mappedWith(wrong, 6));
  const auto equations = lensEquations(at);
  ASSERT_TRUE(equations);
  const LensEstimate estimate = estimateLens(*equations, false, true);
  EXPECT_EQ(worthwhile(at, *equations, estimate.change), estimate.change);
  EXPECT_TRUE(worthwhile(at, *equations, -estimate.change).isZero(0)) << "uphill";
  // Equations that promise more than there is.
  LensEquations flat = *equations;
  flat.information *= 0.2;
  const Eigen::Vector3d too_far = estimateLens(flat, false, true).change;
  const Eigen::Vector3d taken = worthwhile(at, flat, too_far);
  EXPECT_LT(taken.norm(), too_far.norm());
}

}  // namespace
}  // namespace edgeslam
