#include "image/pyramid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace edgeslam {
namespace {

// A smooth hill with its top at (x, y).
cv::Mat hill(const cv::Size& size, double top_x, double top_y) {
  cv::Mat image(size, CV_8U);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double squared = (x - top_x) * (x - top_x) + (y - top_y) * (y - top_y);
      image.at<uint8_t>(y, x) = cv::saturate_cast<uint8_t>(20 + 200 * std::exp(-squared / (2 * 12.0 * 12.0)));
    }
  }
  return image;
}

TEST(Pyramid, PixelOfLevelZeroLiesAtItsHalvedCoordinates) {
  const ImagePyramid pyramid = buildPyramid(hill({160, 120}, 83, 58), 4);
  ASSERT_EQ(pyramid.levels.size(), 3U) << "the fourth level would have 15 rows";
  double scale = 1;
  for (const cv::Mat& level : pyramid.levels) {
    double mass = 0;
    double x_moment = 0;
    double y_moment = 0;
    for (int y = 0; y < level.rows; ++y) {
      for (int x = 0; x < level.cols; ++x) {
        const double height = level.at<uint8_t>(y, x) - 20.0;
        mass += height;
        x_moment += height * x;
        y_moment += height * y;
      }
    }
    EXPECT_NEAR(x_moment / mass, 83 * scale, 0.15);
    EXPECT_NEAR(y_moment / mass, 58 * scale, 0.15);
    scale /= 2;
  }
}

TEST(Pyramid, LevelZeroIsTheImageAndTheBorderMayBeRead) {
  const cv::Mat image = hill({64, 48}, 20, 30);
  const ImagePyramid pyramid = buildPyramid(image, 3);
  EXPECT_EQ(cv::norm(pyramid.levels.front(), image, cv::NORM_INF), 0);
  for (const cv::Mat& level : pyramid.levels) {
    cv::Size whole;
    cv::Point offset;
    level.locateROI(whole, offset);
    EXPECT_GE(offset.x, pyramid_border);
    EXPECT_GE(offset.y, pyramid_border);
    EXPECT_GE(whole.width, level.cols + 2 * pyramid_border);
    EXPECT_GE(whole.height, level.rows + 2 * pyramid_border);
  }
}

TEST(Pyramid, TheBorderMirrorsTheImage) {
  const ImagePyramid pyramid = buildPyramid(hill({160, 120}, 20, 100), 3);
  for (const cv::Mat& level : pyramid.levels) {
    // Through the pointer, as windows are read: the whole image goes on to all sides of the level.
    const auto at = [&](int x, int y) { return level.data[static_cast<std::ptrdiff_t>(level.step[0]) * y + x]; };
    for (int k = 1; k <= std::min(pyramid_border, level.rows - 1); ++k) {
      EXPECT_EQ(at(-k, level.rows / 2), at(k, level.rows / 2));
      EXPECT_EQ(at(level.cols - 1 + k, level.rows / 2), at(level.cols - 1 - k, level.rows / 2));
      EXPECT_EQ(at(level.cols / 3, -k), at(level.cols / 3, k));
      EXPECT_EQ(at(level.cols / 3, level.rows - 1 + k), at(level.cols / 3, level.rows - 1 - k));
      EXPECT_EQ(at(-k, level.rows - 1 + k), at(k, level.rows - 1 - k));
    }
  }
}

TEST(Pyramid, FlatStaysFlatAtOddSizes) {
  const ImagePyramid pyramid = buildPyramid(cv::Mat(101, 77, CV_8U, cv::Scalar(93)), 3);
  for (const cv::Mat& level : pyramid.levels) {
    double least = 0;
    double greatest = 0;
    cv::minMaxLoc(level, &least, &greatest);
    EXPECT_EQ(least, 93);
    EXPECT_EQ(greatest, 93);
  }
}

}  // namespace
}  // namespace edgeslam
