#include "image/hidden_part.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace edgeslam {
namespace {

TEST(HiddenPart, ASmallPixelIsHiddenWhereAnyOfItIs) {
  cv::Mat hidden(240, 320, CV_8U, cv::Scalar(0));
  hidden.rowRange(0, 17).setTo(255);
  const cv::Mat part = hiddenPart(hidden, {40, 30});
  EXPECT_EQ(part.size(), cv::Size(40, 30));
  EXPECT_EQ(cv::countNonZero(part), 3 * 40);
}

TEST(HiddenPart, IsFilledWithWhatIsAround) {
  cv::Mat image(30, 40, CV_32F, cv::Scalar(50)), hidden(30, 40, CV_8U, cv::Scalar(0));
  image.rowRange(0, 20).setTo(200);
  hidden.rowRange(0, 20).setTo(255);
  fillHidden(hidden, 2, image);
  EXPECT_NEAR(cv::norm(image, cv::Mat(30, 40, CV_32F, cv::Scalar(50)), cv::NORM_INF), 0, 1e-3);
}

TEST(HiddenPart, WhatIsSeenStaysAsItIs) {
  cv::Mat image(30, 40, CV_32F), hidden(30, 40, CV_8U, cv::Scalar(0));
  cv::randu(image, 0, 255);
  hidden.colRange(10, 20).setTo(255);
  const cv::Mat before = image.clone();
  fillHidden(hidden, 2, image);
  EXPECT_EQ(cv::norm(image, before, cv::NORM_INF, hidden == 0), 0);
}

}  // namespace
}  // namespace edgeslam
