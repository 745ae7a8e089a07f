// P2: of two points across the same edge one stays.
#include "edges/thinning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace edgeslam {
namespace {

// Edge points of a small image and the index that names them, as they come before thinning.
struct MadeEdges {
  std::vector<EdgePixel> points;
  cv::Mat index = cv::Mat(20, 20, CV_32S, cv::Scalar(-1));

  void add(int x, int y, const Eigen::Vector2f& normal, float offset) {
    const bool to_rows = std::abs(normal.x()) >= std::abs(normal.y());
    const Eigen::Vector2f cell(static_cast<float>(x), static_cast<float>(y));
    const Eigen::Vector2f axis = to_rows ? Eigen::Vector2f::UnitX() : Eigen::Vector2f::UnitY();
    index.at<int>(y, x) = static_cast<int>(points.size());
    points.push_back({cell + offset * axis, normal, 10, offset, {x, y}});
  }

  // Of each point in turn: is it still named?
  std::vector<bool> kept() {
    thin(points, index);
    std::vector<bool> kept;
    for (std::size_t i = 0; i < points.size(); ++i)
      kept.push_back(index.at<int>(points[i].cell) == static_cast<int>(i));
    return kept;
  }
};

const Eigen::Vector2f rightwards(1, 0), downwards(0, 1);

using Kept = std::vector<bool>;

// Points next to each other across their edge, with these offsets from their pixels' centres.
Kept keptOfNeighbours(const std::vector<float>& offsets, bool to_rows) {
  MadeEdges edges;
  edges.add(2, 15, rightwards, 0.3f);  // far away: that one point has the number 0 must not matter
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const int at = 5 + static_cast<int>(i);
    edges.add(to_rows ? at : 5, to_rows ? 5 : at, to_rows ? rightwards : downwards, offsets[i]);
  }
  Kept kept = edges.kept();
  EXPECT_TRUE(kept.front());
  kept.erase(kept.begin());
  return kept;
}

TEST(Thinning, OfTwoAcrossTheSameEdgeTheOneNearerToItsPixelsCentreStays) {
  for (const bool to_rows : {true, false}) {
    EXPECT_EQ(keptOfNeighbours({0.1f, 0.4f}, to_rows), (Kept{true, false}));
    EXPECT_EQ(keptOfNeighbours({0.4f, 0.1f}, to_rows), (Kept{false, true}));
    EXPECT_EQ(keptOfNeighbours({-0.1f, 0.4f}, to_rows), (Kept{true, false}));
    EXPECT_EQ(keptOfNeighbours({0.1f, -0.4f}, to_rows), (Kept{true, false})) << "which side of it does not matter";
    EXPECT_EQ(keptOfNeighbours({-0.4f, -0.1f}, to_rows), (Kept{false, true}));
  }
}

// What was taken out is no edge any more and takes nothing out.
TEST(Thinning, OneThatWasTakenOutTakesNoOtherOut) {
  for (const bool to_rows : {true, false}) {
    EXPECT_EQ(keptOfNeighbours({0.1f, 0.2f, 0.3f}, to_rows), (Kept{true, false, true}));
    EXPECT_EQ(keptOfNeighbours({0.3f, 0.1f, 0.2f}, to_rows), (Kept{false, true, false}));
    EXPECT_EQ(keptOfNeighbours({0.3f, 0.2f, 0.1f}, to_rows), (Kept{false, false, true}));
  }
}

TEST(Thinning, NeighboursAlongTheEdgeStay) {
  MadeEdges edges;
  for (int i = 0; i < 6; ++i) edges.add(5, 4 + i, rightwards, 0.1f * static_cast<float>(i));
  for (int i = 0; i < 6; ++i) edges.add(10 + i, 12, downwards, -0.1f * static_cast<float>(i));
  EXPECT_EQ(edges.kept(), Kept(12, true));
}

TEST(Thinning, PointsWithAPixelBetweenThemStay) {
  MadeEdges edges;
  edges.add(5, 5, rightwards, 0.1f);
  edges.add(7, 5, rightwards, 0.4f);
  edges.add(10, 10, downwards, 0.1f);
  edges.add(10, 12, downwards, 0.4f);
  EXPECT_EQ(edges.kept(), Kept(4, true));
}

// Two normals either side of the diagonal. The edge runs from the one point to the other where the second lies along
// it, and past both where it lies across it.
TEST(Thinning, WhereTheEdgeTurnsFromRowsToColumnsNeighboursMayFollowEachOther) {
  const Eigen::Vector2f nearer_to_rows = Eigen::Vector2f(0.75f, 0.66f).normalized(),
                        nearer_to_columns = Eigen::Vector2f(0.66f, 0.75f).normalized();
  MadeEdges across;  // of the diagonal, 0.76 px apart
  across.add(5, 5, nearer_to_rows, 0.0f);
  across.add(6, 5, nearer_to_columns, 0.1f);
  EXPECT_EQ(across.kept(), Kept(2, true)) << "0.75 px apart across it: another piece of the edge";
  MadeEdges same;
  same.add(5, 5, nearer_to_rows, 0.4f);
  same.add(6, 5, nearer_to_columns, -0.3f);
  same.points[1].pixel = Eigen::Vector2f(6, 4.7f);
  const double apart = std::abs(same.points[0].normal.dot(same.points[1].pixel - same.points[0].pixel));
  ASSERT_LT(apart, 0.5);
  EXPECT_EQ(same.kept(), (Kept{false, true})) << "the same piece of the edge";
  MadeEdges of_one_class;  // where both are nearer to rows, they are never told apart
  of_one_class.add(5, 5, nearer_to_rows, 0.0f);
  of_one_class.add(6, 5, nearer_to_rows, 0.1f);
  EXPECT_EQ(of_one_class.kept(), (Kept{true, false}));
}

// Random points: what stays has no neighbour across its edge, what goes lost against a neighbour nearer to its centre.
TEST(Thinning, LeavesEdgesOnePixelWideAndTakesNoMoreThanThat) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> offset(-0.5f, 0.5f);
  for (int trial = 0; trial < 50; ++trial) {
    const bool to_rows = trial % 2 == 0;
    MadeEdges edges;
    for (int y = 3; y < 17; ++y) {
      for (int x = 3; x < 17; ++x) {
        if (random() % 3 != 0) edges.add(x, y, to_rows ? rightwards : downwards, offset(random));
      }
    }
    const cv::Mat before = edges.index.clone();
    const Kept kept = edges.kept();
    const cv::Point across = to_rows ? cv::Point(1, 0) : cv::Point(0, 1);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const EdgePixel& point = edges.points[i];
      bool lost = false;
      for (const cv::Point& beside : {point.cell - across, point.cell + across}) {
        const int other = before.at<int>(beside);
        if (other < 0) continue;
        EXPECT_FALSE(kept[i] && kept[static_cast<std::size_t>(other)]) << point.cell.x << " " << point.cell.y;
        lost |= std::abs(edges.points[static_cast<std::size_t>(other)].offset) <= std::abs(point.offset);
      }
      EXPECT_TRUE(kept[i] || lost) << point.cell.x << " " << point.cell.y;
    }
  }
}

}  // namespace
}  // namespace edgeslam
