// How exactly points are measured in dim light (design, section 5: what a measurement is).
#include "edges/point_accuracy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "edges/point_choice.h"
#include "unit/edges/synthetic_image.h"

namespace edgeslam {
namespace {

TEST(PointAccuracy, OnlyWhatIsMoreThanUsualIsAdded) {
  const PointAccuracyOptions usual;
  EXPECT_EQ(accuracyIn(withNoise(flatDrawing(120), 2, 1), usual).excess_noise, 0);
  const PointAccuracy dim = accuracyIn(withNoise(flatDrawing(120), 5, 1), usual);
  EXPECT_NEAR(dim.excess_noise, gradientVariance(5) - usual.noise, 1.5);
  EXPECT_EQ(dim.options.noise, usual.noise);
}

double cornerShare(const cv::Mat& image, const PointAccuracy& accuracy) {
  const std::vector<ChosenPoint> points = choosePoints(image, detectEdges(image, {}), {}, PointSpread(), accuracy);
  EXPECT_GT(points.size(), 20U);
  const auto corners = std::count_if(points.begin(), points.end(), [](const ChosenPoint& p) { return p.corner; });
  return static_cast<double>(corners) / static_cast<double>(points.size());
}

TEST(PointAccuracy, InDimLightAStraightEdgeIsNotCornerLike) {
  const cv::Mat dim = withNoise(renderLine(drawing_size, lineThrough(160, 120, 20), 50, 85), 5, 2);
  EXPECT_GT(cornerShare(dim, {}), 0.8) << "without the image's noise";
  EXPECT_LT(cornerShare(dim, accuracyIn(dim, {})), 0.2);
}

TEST(PointAccuracy, InDimLightACornerIsStillOne) {
  const cv::Mat board = withNoise(renderCheckerboard(drawing_size, 40), 5, 2);
  const PointAccuracy accuracy = accuracyIn(board, {});
  EXPECT_GT(accuracy.excess_noise, 5);
  for (const ChosenPoint& point : choosePoints(board, detectEdges(board, {}), {}, PointSpread(), accuracy)) {
    const Eigen::Vector2f in_square(std::fmod(point.pixel.x() + 0.5F, 40.F), std::fmod(point.pixel.y() + 0.5F, 40.F));
    const auto fromCorner = [](float along) { return std::min(along, 40 - along); };
    const float distance = std::max(fromCorner(in_square.x()), fromCorner(in_square.y()));
    if (distance > 3 && distance < 12) continue;  // the window has part of the corner
    EXPECT_EQ(point.corner, distance <= 3) << point.pixel.transpose();
  }
}

}  // namespace
}  // namespace edgeslam
