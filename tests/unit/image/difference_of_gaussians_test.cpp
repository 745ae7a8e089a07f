// P1: the difference of Gaussians is that of the formula, and the same bits on every instruction set.
#include "image/difference_of_gaussians.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "unit/image/every_target.h"
#include "unit/image/kernel_images.h"

namespace edgeslam {
namespace {

cv::Mat noise(const cv::Size& size) {
  cv::Mat image(size, CV_8U);
  cv::randu(image, 0, 256);
  return image;
}

TEST(DifferenceOfGaussians, OfAFlatImageIsZero) {
  for (const int grey : {0, 1, 128, 255}) {
    DifferenceOfGaussians images;
    differenceOfGaussians(cv::Mat(20, 30, CV_8U, cv::Scalar(grey)), 1.78, 1.26, images);
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 30; ++x) {
        EXPECT_EQ(images.narrow.at<uint16_t>(y, x), grey * blur_scale);
        EXPECT_EQ(images.dog.at<int16_t>(y, x), 0);
      }
    }
  }
}

TEST(DifferenceOfGaussians, SpreadsAPointAsGaussiansOfTheirWidths) {
  cv::Mat point(61, 61, CV_8U, cv::Scalar(0));
  point.at<uint8_t>(30, 30) = 255;
  DifferenceOfGaussians images;
  differenceOfGaussians(point, 1.5, 5.0 / 3, images);
  cv::Mat wide;
  cv::subtract(images.narrow, images.dog, wide, cv::noArray(), CV_16U);
  for (const auto& [image, sigma] : {std::make_pair(images.narrow, 1.5), std::make_pair(wide, 2.5)}) {
    for (int y = 26; y <= 34; ++y) {
      for (int x = 26; x <= 34; ++x) {
        const double squared = (x - 30) * (x - 30) + (y - 30) * (y - 30);
        const double expected =
            255 * blur_scale * std::exp(-squared / (2 * sigma * sigma)) / (2 * M_PI * sigma * sigma);
        EXPECT_NEAR(image.at<uint16_t>(y, x), expected, 0.02 * 255 * blur_scale / (2 * M_PI * sigma * sigma));
      }
    }
  }
}

// The 16-bit blur of OpenCV has the same weights and rounds once too.
TEST(DifferenceOfGaussians, HasTheBitsOfOpenCvsBlur) {
  for (const double sigma : {0.5, 1.0, 1.78, 3.0}) {
    const cv::Mat image = noise({101, 63});
    DifferenceOfGaussians images;
    differenceOfGaussians(image, sigma, 1.26, images);
    cv::Mat scaled;
    image.convertTo(scaled, CV_16U, blur_scale);
    const int side = 2 * images.to_narrow.radius() + 1;
    cv::Mat blurred;
    cv::GaussianBlur(scaled, blurred, {side, side}, sigma, sigma, cv::BORDER_REPLICATE);
    EXPECT_EQ(cv::norm(images.narrow, blurred, cv::NORM_INF), 0) << sigma;
    const int further_side = 2 * images.to_wide.radius() + 1;
    const double further = sigma * std::sqrt(1.26 * 1.26 - 1);
    cv::Mat wide;
    cv::GaussianBlur(images.narrow.clone(), wide, {further_side, further_side}, further, further, cv::BORDER_REPLICATE);
    cv::Mat difference;
    cv::subtract(blurred, wide, difference, cv::noArray(), CV_16S);
    EXPECT_EQ(cv::norm(images.dog, difference, cv::NORM_INF), 0) << sigma;
  }
}

TEST(DifferenceOfGaussians, TakesImagesSmallerThanItsKernels) {
  DifferenceOfGaussians images;
  for (const cv::Size& size : {cv::Size(1, 1), cv::Size(3, 3), cv::Size(50, 1), cv::Size(1, 50), cv::Size(7, 90)}) {
    differenceOfGaussians(cv::Mat(size, CV_8U, cv::Scalar(200)), 2, 2, images);
    ASSERT_EQ(images.narrow.size(), size);
    ASSERT_EQ(images.dog.size(), size);
    EXPECT_EQ(images.narrow.at<uint16_t>(0, 0), 200 * blur_scale);
    EXPECT_EQ(cv::countNonZero(images.dog), 0);
  }
}

TEST(DifferenceOfGaussians, OfEqualWidthsIsZero) {
  DifferenceOfGaussians images;
  differenceOfGaussians(noise({40, 40}), 1.78, 1, images);
  EXPECT_EQ(cv::countNonZero(images.dog), 0);
}

TEST(DifferenceOfGaussians, HasTheBitsOfTheReferenceOnEveryTarget) {
  const std::vector<cv::Mat> images = kernelImages(0);
  onEveryTarget([&] {
    DifferenceOfGaussians made;
    DifferenceOfGaussians expected;
    for (const auto& [sigma, ratio] : {std::make_pair(1.78, 1.26), std::make_pair(0.3, 1.05), std::make_pair(0.01, 1.0),
                                       std::make_pair(0.9, 1.26), std::make_pair(2.0, 1.6), std::make_pair(6.0, 3.0)}) {
      for (const cv::Mat& image : images) {
        if (sigma > 2 && image.total() > 10000) continue;
        differenceOfGaussians(image, sigma, ratio, made);
        differenceOfGaussiansReference(image, sigma, ratio, expected);
        ASSERT_EQ(cv::norm(made.narrow, expected.narrow, cv::NORM_INF), 0) << image.size() << " " << sigma;
        ASSERT_EQ(cv::norm(made.dog, expected.dog, cv::NORM_INF), 0) << image.size() << " " << sigma;
      }
    }
  });
}

}  // namespace
}  // namespace edgeslam
