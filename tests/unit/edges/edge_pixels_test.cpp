// P1: the pixels through which edges run are the same bits on every instruction set.
#include "edges/edge_pixels.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "unit/edges/synthetic_image.h"
#include "unit/image/every_target.h"
#include "unit/image/kernel_images.h"

namespace edgeslam {
namespace {

void expectSame(const EdgePixels& a, const EdgePixels& b) {
  ASSERT_EQ(a.points.size(), b.points.size());
  for (size_t i = 0; i < a.points.size(); ++i) {
    ASSERT_EQ(std::memcmp(&a.points[i], &b.points[i], sizeof(EdgePixel)), 0)
        << a.points[i].cell << " " << b.points[i].cell;
  }
}

TEST(EdgePixels, HaveTheBitsOfTheReferenceOnEveryTarget) {
  std::vector<cv::Mat> images = kernelImages(0);
  images.push_back(renderTexture({320, 240}, 1));
  images.push_back(withNoise(renderTexture({201, 150}, 2), 3, 1));
  images.push_back(renderCheckerboard({160, 120}, 5));
  size_t found = 0;
  onEveryTarget([&] {
    DifferenceOfGaussians blurs;
    EdgePixels made;
    EdgePixels expected;
    cv::Mat made_index;
    cv::Mat expected_index;
    for (const cv::Mat& image : images) {
      for (int radius = 1; radius <= 4; ++radius) {
        EdgeOptions options;
        options.plane_fit_radius = radius;
        options.sign_balance = radius == 3 ? 1 : 0.4;
        options.gradient_threshold = std::array<double, 4>{0, 1.5, 0.12, 17.3}[static_cast<size_t>(radius) - 1];
        differenceOfGaussians(image, options.sigma, options.sigma_ratio, blurs);
        findEdgePixels(blurs, options, made, made_index);
        findEdgePixelsReference(blurs, options, expected, expected_index);
        ASSERT_NO_FATAL_FAILURE(expectSame(made, expected)) << image.size() << " " << radius;
        ASSERT_EQ(cv::norm(made_index, expected_index, cv::NORM_INF), 0);
        found += made.points.size();
      }
    }
  });
  EXPECT_GT(found, 10000U);
}

TEST(EdgePixels, WhereThereIsNoRoomForAllTheLowestRowsAreLeftOut) {
  cv::Mat stripes(120, 160, CV_8U);
  for (int x = 0; x < stripes.cols; ++x) stripes.col(x).setTo(x / 2 % 2 == 0 ? 255 : 0);
  DifferenceOfGaussians blurs;
  differenceOfGaussians(stripes, 1.0, 1.26, blurs);
  EdgePixels pixels;
  cv::Mat index;
  findEdgePixels(blurs, {}, pixels, index);
  EXPECT_EQ(pixels.points.size(), mostEdgePoints(stripes.size()));
  int named = 0;
  for (int y = 0; y < index.rows; ++y) {
    for (int x = 0; x < index.cols; ++x) {
      const int i = index.at<int>(y, x);
      if (i < 0) continue;
      ++named;
      EXPECT_EQ(pixels.points.at(static_cast<size_t>(i)).cell, cv::Point(x, y));
    }
  }
  EXPECT_EQ(named, static_cast<int>(pixels.points.size()));
  EXPECT_LT(pixels.points.back().cell.y, 100);
}

}  // namespace
}  // namespace edgeslam
