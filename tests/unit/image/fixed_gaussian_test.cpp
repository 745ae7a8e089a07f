// P1: the weights of a Gaussian blur sum up to one and follow the Gaussian's shape.
#include "image/fixed_gaussian.h"

#include <gtest/gtest.h>

#include <cmath>

namespace edgeslam {
namespace {

TEST(FixedGaussian, WeightsFollowTheCurveAndSumToOne) {
  for (const double sigma : {0.3, 0.7, 1.0, 1.78, 2.5, 10.0, 40.0}) {
    const FixedGaussian gaussian = fixedGaussian(sigma);
    int sum = gaussian.weights[0];
    for (int k = 1; k <= gaussian.radius(); ++k) sum += 2 * gaussian.weights[static_cast<size_t>(k)];
    EXPECT_EQ(sum, 1 << weight_bits) << sigma;
    EXPECT_GE(gaussian.radius(), 2.5 * sigma);
    for (int k = 1; k <= gaussian.radius(); ++k) {
      const double expected = gaussian.weights[0] * std::exp(-0.5 * k * k / (sigma * sigma));
      EXPECT_NEAR(gaussian.weights[static_cast<size_t>(k)], expected, 2.5 + 1e-3 * expected) << sigma << " " << k;
    }
  }
}

TEST(FixedGaussian, OfNoWidthIsTheSinglePixel) {
  EXPECT_EQ(fixedGaussian(0).weights, std::vector<int32_t>{1 << weight_bits});
  EXPECT_EQ(fixedGaussian(0.01).radius(), 0);
}

}  // namespace
}  // namespace edgeslam
