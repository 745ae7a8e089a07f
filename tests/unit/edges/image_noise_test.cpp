#include "edges/image_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "edges/point_choice.h"
#include "unit/edges/synthetic_image.h"

namespace edgeslam {
namespace {

const cv::Size size{320, 240};

cv::Mat flat(int grey) { return cv::Mat(size, CV_8U, cv::Scalar(grey)); }

// Half the variance of a pixel: a central difference is half the difference of two.
double gradientVariance(double sigma) { return 0.5 * sigma * sigma; }

TEST(ImageNoise, OfAFlatImageIsThatOfItsPixels) {
  for (const double sigma : {1.0, 2.0, 4.0, 7.0}) {
    EXPECT_NEAR(gradientNoise(withNoise(flat(120), sigma, 3)) / gradientVariance(sigma), 1, 0.15) << sigma;
  }
}

TEST(ImageNoise, EdgesAndTextureOfAThirdOfTheImageHardlyCount) {
  cv::Mat image = renderLine(size, lineThrough(160, 120, 30));
  renderTexture({107, 240}, 1).copyTo(image(cv::Rect(0, 0, 107, 240)));
  EXPECT_LT(gradientNoise(image), 0.1);
  EXPECT_NEAR(gradientNoise(withNoise(image, 4, 5)) / gradientVariance(4), 1, 0.5);
}

TEST(ImageNoise, IsNothingWhereGreyValuesOnlySlope) {
  cv::Mat slope(size, CV_8U);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) slope.at<uint8_t>(y, x) = static_cast<uint8_t>((x + y) / 3);
  }
  EXPECT_LT(gradientNoise(slope), 0.3);
  EXPECT_LT(gradientNoise(flat(0)), 0.02);
}

TEST(ImageNoise, IsBoundedWhateverTheImage) {
  EXPECT_EQ(gradientNoise(withNoise(flat(128), 60, 1)), 32);
  cv::Mat chequered(size, CV_8U);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) chequered.at<uint8_t>(y, x) = (x + y) % 2 == 0 ? 255 : 0;
  }
  EXPECT_EQ(gradientNoise(chequered), 32);
  EXPECT_EQ(gradientNoise(cv::Mat()), 0);
  for (const cv::Size& tiny : {cv::Size(1, 1), cv::Size(2, 50), cv::Size(50, 2), cv::Size(3, 3)}) {
    EXPECT_LE(gradientNoise(cv::Mat(tiny, CV_8U, cv::Scalar(7))), 0.02) << tiny;
  }
}

TEST(ImageNoise, OnlyWhatIsMoreThanUsualIsAdded) {
  const PointChoiceOptions usual;
  EXPECT_EQ(withNoiseOf(withNoise(flat(120), 2, 1), usual).excess_noise, 0);
  const PointChoiceOptions dim = withNoiseOf(withNoise(flat(120), 5, 1), usual);
  EXPECT_NEAR(dim.excess_noise, gradientVariance(5) - usual.noise, 1.5);
  EXPECT_EQ(dim.noise, usual.noise);
  // Of the image at hand, not of the one before.
  EXPECT_EQ(withNoiseOf(flat(120), dim).excess_noise, 0);
}

double cornerShare(const cv::Mat& image, const PointChoiceOptions& options) {
  const std::vector<ChosenPoint> points = choosePoints(image, detectEdges(image, {}), {}, options);
  EXPECT_GT(points.size(), 20U);
  const auto corners = std::count_if(points.begin(), points.end(), [](const ChosenPoint& p) { return p.corner; });
  return static_cast<double>(corners) / static_cast<double>(points.size());
}

TEST(ImageNoise, InDimLightAStraightEdgeIsNotCornerLike) {
  const cv::Mat dim = withNoise(renderLine(size, lineThrough(160, 120, 20), 50, 85), 5, 2);
  EXPECT_GT(cornerShare(dim, {}), 0.8) << "without the image's noise";
  EXPECT_LT(cornerShare(dim, withNoiseOf(dim, {})), 0.2);
}

TEST(ImageNoise, InDimLightACornerIsStillOne) {
  const cv::Mat board = withNoise(renderCheckerboard(size, 40), 5, 2);
  const PointChoiceOptions options = withNoiseOf(board, {});
  EXPECT_GT(options.excess_noise, 5);
  for (const ChosenPoint& point : choosePoints(board, detectEdges(board, {}), {}, options)) {
    const Eigen::Vector2f in_square(std::fmod(point.pixel.x() + 0.5F, 40.F), std::fmod(point.pixel.y() + 0.5F, 40.F));
    const auto fromCorner = [](float along) { return std::min(along, 40 - along); };
    const float distance = std::max(fromCorner(in_square.x()), fromCorner(in_square.y()));
    if (distance > 3 && distance < 12) continue;  // the window has part of the corner
    EXPECT_EQ(point.corner, distance <= 3) << point.pixel.transpose();
  }
}

}  // namespace
}  // namespace edgeslam
