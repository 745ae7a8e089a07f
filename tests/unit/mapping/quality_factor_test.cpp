// P15: the quality factor is high for a true structure and low for one torn apart.
#include "mapping/quality_factor.h"

#include <gtest/gtest.h>

#include "unit/adjustment/synthetic_scene.h"

namespace edgeslam {
namespace {

Camera undistortedCamera() {
  return {CameraModel::pinhole_radial_tangential, 640, 480, 500, 500, 320, 240, {0, 0, 0, 0, 0}};
}

// Points of a straight edge of space, `spacing` [px] apart in the image.
void addEdge(const Eigen::Vector3d& from, const Eigen::Vector3d& to, int chain, std::vector<QualityPoint>& points,
             double spacing = 10) {
  const Eigen::Vector2d start = project(undistortedCamera(), from), way = project(undistortedCamera(), to) - start;
  const int count = static_cast<int>(way.norm() / spacing);
  for (int k = 0; k <= count; ++k) {
    QualityPoint point;
    const double share = static_cast<double>(k) / count;
    point.pixel = start + share * way;
    point.normal = Eigen::Vector2d(-way.y(), way.x()).normalized();
    point.bearing = bearing(undistortedCamera(), point.pixel);
    const double inverse_z = (1 - share) / from.z() + share / to.z();  // linear in the image
    point.inverse_depth = inverse_z * point.bearing.z();
    point.chain = chain;
    point.order = k;
    points.push_back(point);
  }
}

// A zig-zag panel: upright edges at changing depths, joined by slanted ones.
std::vector<QualityPoint> zigZag() {
  std::vector<QualityPoint> points;
  const double x[] = {-1.2, -0.6, 0, 0.6, 1.2}, z[] = {2.5, 3.2, 2.5, 3.2, 2.5};
  int chain = 0;
  for (int i = 0; i < 5; ++i) {
    addEdge({x[i], -0.7, z[i]}, {x[i], 0.7, z[i]}, chain++, points);
    if (i == 4) break;
    addEdge({x[i], -0.7, z[i]}, {x[i + 1], -0.7, z[i + 1]}, chain++, points);
    addEdge({x[i], 0.7, z[i]}, {x[i + 1], 0.7, z[i + 1]}, chain++, points);
  }
  return points;
}

TEST(QualityFactor, ATrueStructureIsKept) {
  const QualityFactor quality = qualityFactor(zigZag(), QualityOptions());
  EXPECT_GT(quality.pieces, 100);
  EXPECT_GT(quality.share(), 0.99);
}

TEST(QualityFactor, TheOrderOfThePointsGivenDoesNotMatter) {
  std::vector<QualityPoint> points = zigZag();
  const QualityFactor straight = qualityFactor(points, QualityOptions());
  std::reverse(points.begin(), points.end());
  const QualityFactor reversed = qualityFactor(points, QualityOptions());
  EXPECT_EQ(straight.pieces, reversed.pieces);
  EXPECT_EQ(straight.kept, reversed.kept);
}

TEST(QualityFactor, ASmallerImageOfTheSameIsJudgedAlike) {
  std::vector<QualityPoint> points = zigZag();
  test::Random random(4);
  for (QualityPoint& point : points) point.inverse_depth *= 1 + test::gaussian(random, 0.05);
  QualityOptions options;
  options.neighbour_deg = 0.9 * options.neighbour_px / undistortedCamera().fx * 180 / M_PI;
  const QualityFactor large = qualityFactor(points, options);
  for (QualityPoint& point : points) point.pixel *= 0.5;
  const QualityFactor small = qualityFactor(points, options);
  EXPECT_GT(large.pieces, large.kept);
  EXPECT_EQ(small.pieces, large.pieces);
  EXPECT_EQ(small.kept, large.kept);
}

TEST(QualityFactor, SmallErrorsOfDepthDoNotHarm) {
  std::vector<QualityPoint> points = zigZag();
  test::Random random(1);
  for (QualityPoint& point : points) point.inverse_depth *= 1 + test::gaussian(random, 0.005);
  EXPECT_GT(qualityFactor(points, QualityOptions()).share(), 0.95);
}

// Every edge by itself is straight, but they no longer meet where they meet in the image: what wrong poses do.
TEST(QualityFactor, EdgesTornApartWhereTheyMeetScoreLow) {
  std::vector<QualityPoint> points;
  for (int column = 0; column < 12; ++column) {
    for (int row = 0; row < 8; ++row) {
      const double x = -1.3 + 0.22 * column, y = -0.9 + 0.22 * row;
      // The upright edges stand half as far as the level ones that cross them in the image.
      addEdge({0.5 * x, 0.5 * y - 0.03, 1.5}, {0.5 * x, 0.5 * y + 0.03, 1.5}, 2 * (8 * column + row), points, 4);
      addEdge({x - 0.05, y, 3}, {x + 0.05, y, 3}, 2 * (8 * column + row) + 1, points, 6);
    }
  }
  QualityOptions options;
  const QualityFactor torn = qualityFactor(points, options);
  for (QualityPoint& point : points) point.inverse_depth = point.bearing.z() / 3;
  const QualityFactor whole = qualityFactor(points, options);
  EXPECT_EQ(torn.pieces, whole.pieces);
  EXPECT_GT(whole.share(), 0.99);
  EXPECT_LT(torn.share(), 0.6);
}

TEST(QualityFactor, AnEdgeWhosePointsJumpInDepthIsNotKept) {
  std::vector<QualityPoint> points;
  addEdge({-1, -0.5, 3}, {1, 0.5, 3}, 0, points);
  EXPECT_EQ(qualityFactor(points, QualityOptions()).share(), 1);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].inverse_depth *= i % 2 == 0 ? 1.08 : 0.92;
  EXPECT_EQ(qualityFactor(points, QualityOptions()).share(), 0);
}

TEST(QualityFactor, NoiseInPlaceOfDepthScoresLow) {
  std::vector<QualityPoint> points = zigZag();
  test::Random random(2);
  for (QualityPoint& point : points) point.inverse_depth *= test::uniform(random, 0.5, 2);
  EXPECT_LT(qualityFactor(points, QualityOptions()).share(), 0.25);
}

TEST(QualityFactor, PointsWithoutDepthCountAgainst) {
  std::vector<QualityPoint> points;
  addEdge({-1, -0.5, 3}, {1, 0.5, 3}, 0, points);
  const int pieces = qualityFactor(points, QualityOptions()).pieces;
  for (const double none : {0.0, -0.3, std::nan(""), HUGE_VAL}) {
    std::vector<QualityPoint> gone = points;
    gone[5].inverse_depth = none;
    const QualityFactor quality = qualityFactor(gone, QualityOptions());
    EXPECT_EQ(quality.pieces, pieces) << none;
    EXPECT_EQ(quality.kept, pieces - 3) << none;  // the pieces that it is part of
  }
}

TEST(QualityFactor, WithoutPiecesThereIsNoQuality) {
  EXPECT_EQ(qualityFactor({}, QualityOptions()).share(), 0);
  std::vector<QualityPoint> points;
  addEdge({-1, -0.5, 3}, {1, 0.5, 3}, 0, points);
  EXPECT_EQ(qualityFactor({points[0], points[1]}, QualityOptions()).pieces, 0) << "two points are no piece";
  for (QualityPoint& point : points) point.chain = -1;
  EXPECT_EQ(qualityFactor(points, QualityOptions()).pieces, 0) << "points of no edge are no piece";
  std::vector<QualityPoint> sparse;
  addEdge({-1, -0.5, 3}, {1, 0.5, 3}, 0, sparse, 30);
  EXPECT_EQ(qualityFactor(sparse, QualityOptions()).pieces, 0) << "no neighbours";
}

TEST(QualityFactor, ABentEdgeIsNoStraightPiece) {
  std::vector<QualityPoint> points;
  addEdge({-1, -0.5, 3}, {1, 0.5, 3}, 0, points);
  points[5].pixel += 3 * points[5].normal;
  const QualityFactor quality = qualityFactor(points, QualityOptions());
  EXPECT_EQ(quality.pieces, static_cast<int>(points.size()) - 2 - 3);
}

}  // namespace
}  // namespace edgeslam
