// Straight edges are found along chains, where they are and with the brighter side told; curves are none.
#include "edges/straight_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "synthetic_image.h"

namespace edgeslam {
namespace {

constexpr int dark_grey = 60, bright_grey = 160;

// A turned square, drawn four times as large.
const std::vector<Eigen::Vector2d> panel_corners{{100, 60}, {220, 75}, {205, 190}, {90, 170}};

cv::Mat polygon(int inside, int outside) {
  cv::Mat large(4 * 240, 4 * 320, CV_8U, cv::Scalar(outside)), image;
  std::vector<cv::Point> points;
  for (const Eigen::Vector2d& corner : panel_corners) {
    points.emplace_back(static_cast<int>(4 * corner.x() + 1.5), static_cast<int>(4 * corner.y() + 1.5));
  }
  cv::fillConvexPoly(large, points, cv::Scalar(inside));
  cv::resize(large, image, {320, 240}, 0, 0, cv::INTER_AREA);
  cv::GaussianBlur(image, image, {}, 0.7);
  return image;
}

StraightEdges edgesOf(const cv::Mat& image, const StraightEdgeOptions& options = {}) {
  return straightEdges(cameraOfDrawing(), detectEdges(image, EdgeOptions()), options);
}

// Distance of a pixel from the nearest side's line, and from the nearest corner.
double offSides(const Eigen::Vector2d& pixel) {
  double least = 1e9;
  for (std::size_t i = 0; i < panel_corners.size(); ++i) {
    const Eigen::Vector2d a = panel_corners[i],
                          along = (panel_corners[(i + 1) % panel_corners.size()] - a).normalized();
    least = std::min(least, std::abs(along.x() * (pixel - a).y() - along.y() * (pixel - a).x()));
  }
  return least;
}

TEST(StraightEdges, AreTheSidesOfAPolygon) {
  const StraightEdges edges = edgesOf(polygon(bright_grey, dark_grey));
  ASSERT_EQ(edges.size(), panel_corners.size());
  for (const StraightEdge& edge : edges) {
    EXPECT_GT((edge.to - edge.from).norm(), 90);
    for (const Eigen::Vector2d& end : {edge.from, edge.to}) EXPECT_LT(offSides(end), 0.35);
    EXPECT_NEAR((project(cameraOfDrawing(), edge.from_bearing) - edge.from).norm(), 0, 1e-6);
  }
}

// Going from the first end to the second, the brighter side is on the left as seen on the screen.
TEST(StraightEdges, TellTheBrighterSide) {
  const Eigen::Vector2d middle(155, 125);
  for (const bool is_bright : {true, false}) {
    const StraightEdges edges = edgesOf(is_bright ? polygon(bright_grey, dark_grey) : polygon(dark_grey, bright_grey));
    ASSERT_EQ(edges.size(), panel_corners.size());
    for (const StraightEdge& edge : edges) {
      const Eigen::Vector2d along = edge.to - edge.from, to_middle = middle - edge.from;
      const bool middle_is_left = along.x() * to_middle.y() - along.y() * to_middle.x() < 0;
      EXPECT_EQ(middle_is_left, is_bright);
    }
  }
}

TEST(StraightEdges, AreNotFoundOnCircles) {
  for (const int radius : {40, 70, 100}) {
    cv::Mat large(4 * 240, 4 * 320, CV_8U, cv::Scalar(dark_grey)), image;
    cv::circle(large, {640, 480}, 4 * radius, cv::Scalar(bright_grey), cv::FILLED);
    cv::resize(large, image, {320, 240}, 0, 0, cv::INTER_AREA);
    cv::GaussianBlur(image, image, {}, 0.7);
    ASSERT_GT(detectEdges(image, EdgeOptions()).points.size(), 4U * static_cast<unsigned>(radius));
    EXPECT_EQ(edgesOf(image).size(), 0U) << radius;
  }
}

TEST(StraightEdges, AreNoneWhereTheyAreSwitchedOffOrTooShort) {
  StraightEdgeOptions options;
  options.least_length = 130;
  EXPECT_EQ(edgesOf(polygon(bright_grey, dark_grey), options).size(), 0U);
  options = {};
  options.enabled = false;
  EXPECT_EQ(edgesOf(polygon(bright_grey, dark_grey), options).size(), 0U);
}

TEST(StraightEdges, KnowTheirPoints) {
  const StraightEdges edges = edgesOf(polygon(bright_grey, dark_grey));
  ASSERT_FALSE(edges.empty());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const int first = edges[i].first_point, end = edges[i].end_point, index = static_cast<int>(i);
    EXPECT_EQ(straightEdgeOf(edges, first, 0), index);
    EXPECT_EQ(straightEdgeOf(edges, end - 1, 0), index);
    EXPECT_NE(straightEdgeOf(edges, end, 0), index);
    EXPECT_EQ(straightEdgeOf(edges, first + 7, 8), -1);
    EXPECT_EQ(straightEdgeOf(edges, first + 8, 8), index);
    EXPECT_EQ(straightEdgeOf(edges, end - 8, 8), -1);
    EXPECT_EQ(straightEdgeOf(edges, end - 9, 8), index);
  }
  EXPECT_EQ(straightEdgeOf({}, 5, 0), -1);
}

}  // namespace
}  // namespace edgeslam
