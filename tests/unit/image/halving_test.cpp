// P5: an image halved for the pyramid of the flow, the same bits on every instruction set.
#include "image/halving.h"

#include <gtest/gtest.h>

#include "unit/image/every_target.h"
#include "unit/image/kernel_images.h"

namespace edgeslam {
namespace {

TEST(Halving, HasTheBitsOfTheReferenceOnEveryTarget) {
  const std::vector<cv::Mat> images = kernelImages(halving_border);
  onEveryTarget([&] {
    for (const cv::Mat& image : images) {
      cv::Mat halved(halfOf(image.size()), CV_8U, cv::Scalar(1));
      cv::Mat expected(halfOf(image.size()), CV_8U, cv::Scalar(2));
      halve(image, halved);
      halveReference(image, expected);
      ASSERT_EQ(cv::norm(halved, expected, cv::NORM_INF), 0) << image.size();
    }
  });
}

TEST(Halving, WritesNothingBesideTheImage) {
  for (const cv::Mat& image : kernelImages(halving_border)) {
    const cv::Size half = halfOf(image.size());
    cv::Mat whole(half.height + 2, half.width + 2, CV_8U, cv::Scalar(77));
    cv::Mat halved = whole(cv::Rect(cv::Point(1, 1), half));
    halve(image, halved);
    halved.setTo(77);
    EXPECT_EQ(cv::countNonZero(whole != 77), 0) << half;
  }
}

}  // namespace
}  // namespace edgeslam
