// How much noise an image has is measured in it.
#include "edges/image_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "edges/point_choice.h"
#include "unit/edges/synthetic_image.h"

namespace edgeslam {
namespace {

TEST(ImageNoise, OfAFlatImageIsThatOfItsPixels) {
  for (const double sigma : {1.0, 2.0, 4.0, 7.0}) {
    EXPECT_NEAR(gradientNoise(withNoise(flatDrawing(120), sigma, 3)) / gradientVariance(sigma), 1, 0.15) << sigma;
  }
}

TEST(ImageNoise, EdgesAndTextureOfAThirdOfTheImageHardlyCount) {
  cv::Mat image = renderLine(drawing_size, lineThrough(160, 120, 30));
  renderTexture({107, 240}, 1).copyTo(image(cv::Rect(0, 0, 107, 240)));
  EXPECT_LT(gradientNoise(image), 0.1);
  EXPECT_NEAR(gradientNoise(withNoise(image, 4, 5)) / gradientVariance(4), 1, 0.5);
}

TEST(ImageNoise, IsNothingWhereGreyValuesOnlySlope) {
  cv::Mat slope(drawing_size, CV_8U);
  for (int y = 0; y < drawing_size.height; ++y) {
    for (int x = 0; x < drawing_size.width; ++x) slope.at<uint8_t>(y, x) = static_cast<uint8_t>((x + y) / 3);
  }
  EXPECT_LT(gradientNoise(slope), 0.3);
  EXPECT_LT(gradientNoise(flatDrawing(0)), 0.02);
}

TEST(ImageNoise, IsBoundedWhateverTheImage) {
  EXPECT_EQ(gradientNoise(withNoise(flatDrawing(128), 60, 1)), 32);
  cv::Mat chequered(drawing_size, CV_8U);
  for (int y = 0; y < drawing_size.height; ++y) {
    for (int x = 0; x < drawing_size.width; ++x) chequered.at<uint8_t>(y, x) = (x + y) % 2 == 0 ? 255 : 0;
  }
  EXPECT_EQ(gradientNoise(chequered), 32);
  EXPECT_EQ(gradientNoise(cv::Mat()), 0);
  for (const cv::Size& tiny : {cv::Size(1, 1), cv::Size(2, 50), cv::Size(50, 2), cv::Size(3, 3)}) {
    EXPECT_LE(gradientNoise(cv::Mat(tiny, CV_8U, cv::Scalar(7))), 0.02) << tiny;
  }
}

TEST(ImageNoise, WhatIsMaskedDoesNotCount) {
  cv::Mat image = withNoise(flatDrawing(120), 3, 4), mask_image(drawing_size, CV_8U, cv::Scalar(255));
  image.rowRange(0, 150).setTo(7);
  mask_image.rowRange(0, 150).setTo(0);
  const auto mask = makeCameraMask(mask_image);
  EXPECT_LT(gradientNoise(image), 0.1);
  EXPECT_NEAR(gradientNoise(image, mask.get()) / gradientVariance(3), 1, 0.15);
}

}  // namespace
}  // namespace edgeslam
