#include "image/gradient.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace edgeslam {
namespace {

TEST(TwiceGradient, OfARampIsTwiceItsSlope) {
  cv::Mat ramp(20, 30, CV_8U);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 30; ++x) ramp.at<uint8_t>(y, x) = static_cast<uint8_t>(200 - 5 * x + 2 * y);
  }
  const TwiceGradient gradient = twiceGradient(ramp);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 30; ++x) {
      EXPECT_EQ(gradient.x.at<int16_t>(y, x), x == 0 || x == 29 ? -5 : -10);
      EXPECT_EQ(gradient.y.at<int16_t>(y, x), y == 0 || y == 19 ? 2 : 4);
    }
  }
}

TEST(TwiceGradient, HoldsTheLargestStep) {
  cv::Mat step(3, 4, CV_8U, cv::Scalar(0));
  step.colRange(2, 4).setTo(255);
  EXPECT_EQ(twiceGradient(step).x.at<int16_t>(1, 1), 255);
  EXPECT_EQ(twiceGradient(255 - step).x.at<int16_t>(1, 1), -255);
}

TEST(TwiceGradient, TakesImagesOfAnySize) {
  for (const cv::Size& size : {cv::Size(0, 0), cv::Size(1, 1), cv::Size(1, 7), cv::Size(7, 1), cv::Size(2, 2)}) {
    const TwiceGradient gradient = twiceGradient(cv::Mat(size, CV_8U, cv::Scalar(9)));
    EXPECT_EQ(gradient.x.size(), size);
    EXPECT_EQ(cv::countNonZero(gradient.x) + cv::countNonZero(gradient.y), 0);
  }
}

}  // namespace
}  // namespace edgeslam
