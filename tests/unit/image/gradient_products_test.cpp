// Sums of gradient products over a window, which a structure tensor is made of, on every instruction set.
#include "image/gradient_products.h"

#include <gtest/gtest.h>

#include "unit/image/every_target.h"
#include "unit/image/kernel_images.h"

namespace edgeslam {
namespace {

TEST(GradientProducts, OfARampAreItsSlopesTimesTheCount) {
  cv::Mat ramp(40, 50, CV_8U);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 50; ++x) ramp.at<uint8_t>(y, x) = static_cast<uint8_t>(180 - 3 * x + 2 * y);
  }
  const GradientProducts products = gradientProducts(ramp, {12, 9, 15, 7});
  EXPECT_EQ(products.count, 105);
  EXPECT_EQ(products.xx, 105 * 36);
  EXPECT_EQ(products.xy, 105 * -24);
  EXPECT_EQ(products.yy, 105 * 16);
}

TEST(GradientProducts, AtTheBorderTheMissingNeighbourIsTheBorderPixel) {
  const cv::Mat pixels = (cv::Mat_<uint8_t>(1, 3) << 10, 20, 50);
  const GradientProducts products = gradientProducts(pixels, {0, 0, 3, 1});
  EXPECT_EQ(products.xx, 10 * 10 + 40 * 40 + 30 * 30);
  EXPECT_EQ(products.yy, 0);
}

TEST(GradientProducts, AreThoseOfTheReferenceOnEveryTarget) {
  const std::vector<cv::Mat> images = kernelImages(0);
  onEveryTarget([&] {
    cv::RNG random(3);
    for (const cv::Mat& image : images) {
      for (int trial = 0; trial < 40; ++trial) {
        const int x = random.uniform(0, image.cols);
        const int y = random.uniform(0, image.rows);
        const cv::Rect window(x, y, random.uniform(1, image.cols - x + 1), random.uniform(1, image.rows - y + 1));
        const GradientProducts made = gradientProducts(image, window);
        const GradientProducts expected = gradientProductsReference(image, window);
        ASSERT_EQ(made.count, expected.count);
        ASSERT_EQ(made.xx, expected.xx) << window << " of " << image.size();
        ASSERT_EQ(made.xy, expected.xy) << window << " of " << image.size();
        ASSERT_EQ(made.yy, expected.yy) << window << " of " << image.size();
      }
    }
  });
}

}  // namespace
}  // namespace edgeslam
