// P5: the image pyramid that the flow runs on, and its mirrored borders.
#include "image/pyramid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

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

TEST(Pyramid, LevelsAreThoseOfPyrDown) {
  for (const cv::Size& size : {cv::Size(640, 480), cv::Size(333, 241), cv::Size(64, 33)}) {
    cv::Mat expected(size, CV_8U);
    cv::randu(expected, 0, 256);
    const ImagePyramid pyramid = buildPyramid(expected, 6);
    for (const cv::Mat& level : pyramid.levels) {
      ASSERT_EQ(level.size(), expected.size());
      EXPECT_EQ(cv::norm(level, expected, cv::NORM_INF), 0);
      cv::Mat coarser;
      cv::pyrDown(expected, coarser, cv::Size(), cv::BORDER_REFLECT_101);
      expected = coarser;
    }
  }
}

TEST(Pyramid, MemoryIsUsedAgainWhateverItHeldBefore) {
  ImagePyramid pyramid;
  for (const cv::Size& size : {cv::Size(160, 120), cv::Size(160, 120), cv::Size(90, 150), cv::Size(1, 1)}) {
    for (const int level_count : {4, 2, 3}) {
      std::vector<const uint8_t*> before;
      for (const cv::Mat& level : pyramid.levels) before.push_back(level.data);
      const bool same_size = !pyramid.levels.empty() && pyramid.levels[0].size() == size;
      const cv::Mat image = hill(size, 40, 70);
      buildPyramid(image, level_count, pyramid);
      const ImagePyramid fresh = buildPyramid(image, level_count);
      ASSERT_EQ(pyramid.levels.size(), fresh.levels.size());
      for (size_t i = 0; i < fresh.levels.size(); ++i) {
        EXPECT_EQ(cv::norm(pyramid.levels[i], fresh.levels[i], cv::NORM_INF), 0);
        if (same_size && i < before.size()) {
          EXPECT_EQ(pyramid.levels[i].data, before[i]);
        }
      }
    }
  }
}

}  // namespace
}  // namespace edgeslam
