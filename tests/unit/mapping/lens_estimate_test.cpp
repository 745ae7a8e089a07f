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
using test::withPrincipalPointMoved;

constexpr LensParts all{true, true, true}, none{}, only_focal_length{true, false, false},
    only_distortion{false, true, false}, only_principal_point{false, false, true};

LensKnowledge ofCalibration() { return {sigmaOfCalibration(Walk::camera()), LensVector::Zero()}; }

LookedAt lookedAtWith(const Camera& wrong, std::uint64_t seed) {
  return lookedAt(wrong, mappedWith(wrong, seed, test::roll_that_tells));
}

TEST(LensEstimate, TheFocalLengthIsThatWithWhichTheMapFits) {
  for (const double times : {0.92, 1.0, 1.06}) {
    const auto equations = lensEquations(lookedAtWith(withFocalLengths(Walk::camera(), times), 3));
    ASSERT_TRUE(equations);
    const LensEstimate estimate = estimateLens(*equations, ofCalibration(), only_focal_length);
    EXPECT_NEAR(estimate.change(0), -std::log(times), 0.015);
    EXPECT_TRUE(estimate.change.tail<4>().isZero(0));
  }
}

TEST(LensEstimate, ThePrincipalPointIsThatWithWhichTheMapFits) {
  for (const Eigen::Vector2d& off : {Eigen::Vector2d(4, -3), Eigen::Vector2d(-3, 0), Eigen::Vector2d(0, 0)}) {
    const LookedAt at = lookedAtWith(withPrincipalPointMoved(Walk::camera(), off), 12);
    const auto equations = lensEquations(at);
    ASSERT_TRUE(equations);
    const LensEstimate estimate = estimateLens(*equations, ofCalibration(), only_principal_point);
    EXPECT_LT((estimate.change.tail<2>() + off).norm(), 1.0) << off.transpose();
    EXPECT_LT(estimate.sigma.tail<2>().maxCoeff(), 2);
  }
}

// One look says where to go; how far, the looks after it.
TEST(LensEstimate, WhatIsFoundMakesUpForMostOfWhatTheWrongLensCosts) {
  for (const double more : {-0.02, 0.02}) {
    const Camera wrong = withFocalLengths(withDistortion(Walk::camera(), more), 1.04);
    const LookedAt at = lookedAtWith(wrong, 3);
    const auto equations = lensEquations(at);
    ASSERT_TRUE(equations);
    const double of_right = costWith(at, Walk::camera());
    ASSERT_LT(of_right, 0.9 * at.cost);
    const LensVector change = worthwhile(at, *equations, estimateLens(*equations, ofCalibration(), all).change);
    EXPECT_LT(costWith(at, withFound(wrong, withLens(wrong, {}, change))), of_right + 0.5 * (at.cost - of_right))
        << more;
  }
}

TEST(LensEstimate, WhatIsOffIsToldAndNothingElse) {
  const auto toldWith = [](const Camera& wrong, std::uint64_t seed) {
    return toldOfLens(lensEquations(lookedAtWith(wrong, seed)).value(), ofCalibration(), all, none);
  };
  for (std::uint64_t seed = 3; seed <= 5; ++seed) {
    EXPECT_FALSE(any(toldWith(Walk::camera(), seed))) << seed;
    const LensParts focal_length = toldWith(withFocalLengths(Walk::camera(), 1.09), seed);
    EXPECT_TRUE(focal_length.focal_length) << seed;
    EXPECT_FALSE(focal_length.principal_point) << seed;
    const LensParts distortion = toldWith(withDistortion(Walk::camera(), 0.03), seed);
    EXPECT_TRUE(distortion.distortion) << seed;
    EXPECT_FALSE(distortion.principal_point) << seed;
    const LensParts principal_point = toldWith(withPrincipalPointMoved(Walk::camera(), {9, -6}), seed);
    EXPECT_TRUE(principal_point.principal_point) << seed;
    EXPECT_FALSE(principal_point.distortion) << seed;
  }
}

TEST(LensEstimate, WhatWasFoundIsToldAlsoWhereItIsRight) {
  const auto equations = lensEquations(lookedAtWith(Walk::camera(), 3));
  ASSERT_TRUE(equations);
  const LensParts told = toldOfLens(*equations, ofCalibration(), all, only_distortion);
  EXPECT_TRUE(told.distortion);
  EXPECT_FALSE(told.focal_length || told.principal_point);
}

TEST(LensEstimate, MoreThatIsFreeIsLikelierAndKnownNoBetter) {
  const auto equations = lensEquations(lookedAtWith(withDistortion(withFocalLengths(Walk::camera(), 1.05), 0.05), 11));
  ASSERT_TRUE(equations);
  const LensEstimate together = estimateLens(*equations, ofCalibration(), all);
  for (const LensParts& parts : {only_focal_length, only_distortion}) {
    const LensEstimate one = estimateLens(*equations, ofCalibration(), parts);
    EXPECT_GT(together.evidence, one.evidence);
    EXPECT_GT(one.evidence, 0);
    const int free = parts.focal_length ? 0 : 1;
    EXPECT_GE(together.sigma(free), one.sigma(free));
  }
}

TEST(LensEstimate, WhatTheKeyframesDoNotTellTheCalibrationDoes) {
  LensKnowledge known = ofCalibration();
  known.found << 0.1, 0.01, -0.01, 5, -5;
  LensEquations silent;
  const LensEstimate back = estimateLens(silent, known, all);
  EXPECT_TRUE(back.change.isApprox(-known.found, 1e-9));
  EXPECT_TRUE(back.sigma.isApprox(known.sigma, 1e-9));
  silent.information.diagonal() = 1e9 * known.sigma.cwiseAbs2().cwiseInverse();
  EXPECT_LT(estimateLens(silent, known, all).change.cwiseQuotient(known.found).norm(), 1e-6);
}

TEST(LensEstimate, WhereNothingExplainsMuchEachIsTakenByItself) {
  const LookedAt at = lookedAtWith(Walk::camera(), 7);
  const auto together = lensEquations(at), alone = lensEquations(at, 1e6 * at.cost);
  ASSERT_TRUE(together && alone);
  EXPECT_EQ(alone->gradient, together->gradient);
  EXPECT_EQ(alone->information.diagonal(), together->information.diagonal());
  EXPECT_TRUE(alone->information.isDiagonal());
  EXPECT_FALSE(together->information.isDiagonal());
}

TEST(LensEstimate, WhatChangesDoTogetherLeavesEachAShareOfItsOwn) {
  LensMatrix apart = LensMatrix::Identity(), alike;
  apart.topLeftCorner<3, 3>() << 4, 1, 0, 1, 9, -2, 0, -2, 16;
  alike = apart;
  alike(0, 1) = alike(1, 0) = 7;  // one direction has less than no information
  EXPECT_TRUE(wellConditioned(apart).isApprox(apart, 1e-12));
  const LensMatrix mended = wellConditioned(alike);
  EXPECT_TRUE(mended.diagonal().isApprox(alike.diagonal(), 1e-12));
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<LensMatrix>(mended).eigenvalues()(0), 0.03 * 0.9);
  EXPECT_GT(mended(0, 1), 0);
  EXPECT_LT(mended(0, 1), 6);
}

TEST(LensEstimate, ALensIsFoundBesideThatOfTheCalibration) {
  LensVector lens;
  lens << 0.05, 0.01, -0.02, 4, -3;
  const FoundCamera found = withLens(Walk::camera(), {}, lens);
  EXPECT_LT((lensOf(Walk::camera(), found) - lens).norm(), 1e-5);
  const FoundCamera back = withLens(Walk::camera(), found, -lens);
  EXPECT_LT(lensOf(Walk::camera(), back).norm(), 1e-5);
  lens << 0.6, 0, 0, 1000, -1000;
  const FoundCamera farthest = withLens(Walk::camera(), {}, lens);
  EXPECT_NEAR(std::log(farthest.focal_scale), 0.25, 1e-5);
  EXPECT_NEAR(farthest.principal_point[0], 0.05 * Walk::camera().width, 1e-5);
  EXPECT_NEAR(farthest.principal_point[1], -farthest.principal_point[0], 1e-5);
}

TEST(LensEstimate, AChangeIsWorthwhileAsFarAsItTakesOffWhatIsExpected) {
  const LookedAt at = lookedAtWith(withDistortion(Walk::camera(), 0.015), 6);
  const auto equations = lensEquations(at);
  ASSERT_TRUE(equations);
  const LensEstimate estimate = estimateLens(*equations, ofCalibration(), only_distortion);
  EXPECT_EQ(worthwhile(at, *equations, estimate.change), estimate.change);
  EXPECT_TRUE(worthwhile(at, *equations, -estimate.change).isZero(0)) << "uphill";
  // Equations that promise more than there is.
  LensEquations flat = *equations;
  flat.information *= 0.2;
  const LensVector too_far = 4 * estimate.change;
  const LensVector taken = worthwhile(at, flat, too_far);
  EXPECT_LT(taken.norm(), too_far.norm());
}

}  // namespace
}  // namespace edgeslam
