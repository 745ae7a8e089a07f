// Points to track are chosen all over the image, along chains and in every direction.
#include "edges/point_choice.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "unit/edges/synthetic_image.h"

namespace edgeslam {
namespace {

std::vector<ChosenPoint> choose(const cv::Mat& image, const PointChoiceOptions& options = {},
                                const std::vector<Eigen::Vector2f>& occupied = {}) {
  return choosePoints(image, detectEdges(image, {}), occupied, options);
}

TEST(PointChoice, KeepsCountSpacingAndBorder) {
  const cv::Mat image = withNoise(renderTexture({320, 240}, 1), 1, 1);
  std::vector<Eigen::Vector2f> occupied;
  for (int i = 0; i < 40; ++i) occupied.emplace_back(static_cast<float>(8 * i), static_cast<float>(6 * i));
  for (const double spacing : {3.0, 6.0, 20.0}) {
    for (const int count : {0, 30, 60, 100, 5000}) {
      PointChoiceOptions options;
      options.spacing = spacing;
      options.count = count;
      const std::vector<ChosenPoint> points = choose(image, options, occupied);
      EXPECT_LE(static_cast<int>(points.size()), std::max(0, count - 40));
      if (spacing < 10) {
        EXPECT_GE(static_cast<int>(points.size()), std::min(std::max(0, count - 40), 100));
      }
      std::vector<Eigen::Vector2f> all = occupied;
      for (const ChosenPoint& point : points) {
        for (const Eigen::Vector2f& other : all) ASSERT_GE((point.pixel - other).norm(), spacing - 1e-4);
        all.push_back(point.pixel);
        EXPECT_GE(point.pixel.minCoeff(), options.border);
        EXPECT_LE(point.pixel.x(), 319 - options.border);
        EXPECT_LE(point.pixel.y(), 239 - options.border);
      }
    }
  }
}

TEST(PointChoice, CornersComeFirstAndTakeNoMoreThanTheirShare) {
  const cv::Mat board = renderCheckerboard({320, 240}, 40);
  PointChoiceOptions options;
  options.count = 60;
  options.spacing = 12;
  const std::vector<ChosenPoint> points = choose(board, options);
  ASSERT_EQ(points.size(), 60U);
  for (size_t i = 0; i < 30; ++i) {
    ASSERT_TRUE(points[i].corner) << i;
    EXPECT_EQ(points[i].sigma_normal, static_cast<float>(options.accuracy.sigma_corner));
  }
  // The first of all lie on the squares' corners: 7 x 5 of them, of which the share allows 30.
  for (size_t i = 0; i < 20; ++i) {
    const Eigen::Vector2f& pixel = points[i].pixel;
    const float x = std::remainder(pixel.x() + 0.5F, 40.0F);
    const float y = std::remainder(pixel.y() + 0.5F, 40.0F);
    EXPECT_LT(std::hypot(x, y), 4) << pixel.transpose();
  }
}

TEST(PointChoice, BarHasEdgesOnlyAndTheyAreLooseAlongIt) {
  const Line line = lineThrough(100, 80, 20);
  const cv::Mat image =
      withNoise(renderEdge({200, 160}, [&](double x, double y) { return 6 - std::abs(line.distance(x, y)); }), 1, 4);
  const std::vector<ChosenPoint> points = choose(image);
  ASSERT_GT(points.size(), 30U);
  int rising = 0;
  for (const ChosenPoint& point : points) {
    EXPECT_FALSE(point.corner);
    EXPECT_EQ(point.sigma_normal, static_cast<float>(PointAccuracyOptions().sigma_edge));
    EXPECT_GT(point.sigma_tangent, 10 * point.sigma_normal);
    EXPECT_LE(point.sigma_tangent, 1000);
    const double distance = line.distance(point.pixel.x(), point.pixel.y());
    EXPECT_NEAR(std::abs(distance), 6, 0.3);
    EXPECT_GT(std::abs(point.normal.cast<double>().dot(line.normal)), std::cos(1.5 * M_PI / 180));
    // Bright inside.
    EXPECT_LT(distance * point.normal.cast<double>().dot(line.normal), 0);
    EXPECT_GE(point.chain, 0);
    rising += distance < 0 ? 1 : 0;
  }
  EXPECT_GT(rising, 10);
  EXPECT_LT(rising, static_cast<int>(points.size()) - 10);
}

TEST(PointChoice, RareDirectionsAreTakenToo) {
  // Many steep upright edges and two faint level ones.
  cv::Mat image = renderEdge({320, 240}, [](double x, double) { return 10 - std::abs(std::remainder(x, 40)); });
  for (int y = 100; y < 140; ++y) {
    for (int x = 0; x < 320; ++x) image.at<uint8_t>(y, x) = cv::saturate_cast<uint8_t>(image.at<uint8_t>(y, x) + 25);
  }
  PointChoiceOptions options;
  options.count = 160;
  options.corner_share = 0;
  std::array<int, 2> of_direction{};
  for (const ChosenPoint& point : choose(image, options)) {
    if (point.corner) continue;
    ++of_direction[std::abs(point.normal.x()) > std::abs(point.normal.y()) ? 0 : 1];
  }
  EXPECT_GT(of_direction[0], 60);
  EXPECT_GE(of_direction[1], 10);
}

TEST(PointChoice, RichRegionDoesNotTakeAll) {
  cv::Mat image = renderCheckerboard({320, 240}, 12);
  image(cv::Rect(160, 0, 160, 240)).setTo(60);
  const Line line = lineThrough(240, 120, 100);
  cv::Mat right = renderLine({320, 240}, line, 60, 90);
  right(cv::Rect(160, 0, 160, 240)).copyTo(image(cv::Rect(160, 0, 160, 240)));
  PointChoiceOptions options;
  options.count = 100;
  int on_line = 0;
  for (const ChosenPoint& point : choose(image, options)) on_line += point.pixel.x() > 170 ? 1 : 0;
  EXPECT_GE(on_line, 8);
}

TEST(PointChoice, FillsWhereTrackedPointsAreFew) {
  const cv::Mat image = renderCheckerboard({320, 240}, 20);
  std::vector<Eigen::Vector2f> occupied;
  for (const ChosenPoint& point : choose(image)) {
    if (point.pixel.x() < 160) occupied.push_back(point.pixel);
  }
  ASSERT_GT(occupied.size(), 50U);
  PointChoiceOptions options;
  options.count = static_cast<int>(occupied.size()) + 40;
  for (const ChosenPoint& point : choose(image, options, occupied)) EXPECT_GT(point.pixel.x(), 159);
}

TEST(PointChoice, BadOccupiedPixelsDoNoHarm) {
  const cv::Mat image = renderTexture({200, 150}, 3);
  const std::vector<Eigen::Vector2f> occupied = {{std::nanf(""), 1}, {1e30F, -1e30F}, {-INFINITY, 3}, {-50, 400}};
  EXPECT_GT(choose(image, {}, occupied).size(), 50U);
}

TEST(PointChoice, NothingToChooseGivesNothing) {
  EXPECT_TRUE(choose(cv::Mat()).empty());
  EXPECT_TRUE(choose(cv::Mat(100, 100, CV_8U, cv::Scalar(90))).empty());
  EXPECT_TRUE(choose(renderLine({20, 20}, lineThrough(10, 10, 0))).empty()) << "all within the border";
}

TEST(PointChoice, RepeatsToTheLastBit) {
  const cv::Mat image = withNoise(renderTexture({320, 240}, 8), 2, 5);
  const std::vector<ChosenPoint> first = choose(image);
  const std::vector<ChosenPoint> second = choose(image.clone());
  ASSERT_GT(first.size(), 100U);
  ASSERT_EQ(first.size(), second.size());
  for (size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].pixel, second[i].pixel);
    EXPECT_EQ(first[i].normal, second[i].normal);
    EXPECT_EQ(first[i].sigma_tangent, second[i].sigma_tangent);
  }
}

}  // namespace
}  // namespace edgeslam
