#include "image/gaussian_blur.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace edgeslam {
namespace {

TEST(GaussianBlur, FlatImageStaysFlat) {
  for (const int grey : {0, 1, 128, 255}) {
    const cv::Mat blurred = blurGrey(cv::Mat(20, 30, CV_8U, cv::Scalar(grey)), 1.78);
    ASSERT_EQ(blurred.type(), CV_16U);
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 30; ++x) EXPECT_NEAR(blurred.at<uint16_t>(y, x), grey * kBlurScale, 1);
    }
  }
}

TEST(GaussianBlur, SpreadsAPointAsAGaussianOfItsWidth) {
  cv::Mat point(61, 61, CV_8U, cv::Scalar(0));
  point.at<uint8_t>(30, 30) = 255;
  const cv::Mat narrow = blurGrey(point, 1.5);
  const cv::Mat wide = blurFurther(narrow, 1.5, 2.5);
  for (const auto& [image, sigma] : {std::make_pair(narrow, 1.5), std::make_pair(wide, 2.5)}) {
    for (int y = 26; y <= 34; ++y) {
      for (int x = 26; x <= 34; ++x) {
        const double squared = (x - 30) * (x - 30) + (y - 30) * (y - 30);
        const double expected =
            255 * kBlurScale * std::exp(-squared / (2 * sigma * sigma)) / (2 * M_PI * sigma * sigma);
        EXPECT_NEAR(image.at<uint16_t>(y, x), expected, 0.02 * 255 * kBlurScale / (2 * M_PI * sigma * sigma));
      }
    }
  }
}

TEST(GaussianBlur, TakesImagesSmallerThanItsKernel) {
  EXPECT_TRUE(blurGrey(cv::Mat(0, 0, CV_8U), 2).empty());
  for (const cv::Size& size : {cv::Size(1, 1), cv::Size(3, 3), cv::Size(50, 1), cv::Size(1, 50)}) {
    const cv::Mat blurred = blurFurther(blurGrey(cv::Mat(size, CV_8U, cv::Scalar(200)), 2), 2, 4);
    ASSERT_EQ(blurred.size(), size);
    EXPECT_NEAR(blurred.at<uint16_t>(0, 0), 200 * kBlurScale, 2);
  }
}

TEST(GaussianBlur, NoFurtherIsNoChange) {
  cv::Mat image(40, 40, CV_8U);
  cv::randu(image, 0, 255);
  const cv::Mat blurred = blurGrey(image, 1.78);
  EXPECT_EQ(cv::norm(blurred, blurFurther(blurred, 1.78, 1.78), cv::NORM_INF), 0);
}

}  // namespace
}  // namespace edgeslam
