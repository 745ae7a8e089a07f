// P22: how much of a frame the map explains.
#include "places/explained_edges.h"

#include <gtest/gtest.h>

namespace edgeslam::test {
namespace {

// A horizontal edge from x = 20 to 219 at height y.
void addEdge(EdgeMap& edges, float y) {
  for (int x = 20; x < 220; ++x) {
    EdgePoint point;
    point.pixel = {static_cast<float>(x), y};
    point.normal = {0, 1};
    edges.points.push_back(point);
  }
}

EdgeMap emptyMap() {
  EdgeMap edges;
  edges.index = cv::Mat(240, 320, CV_32S, cv::Scalar(-1));
  return edges;
}

VisiblePoints pointsAlong(float from, float to, float y, const Eigen::Vector2f& normal) {
  VisiblePoints points;
  for (float x = from; x <= to; x += 20) {
    VisiblePoint point;
    point.pixel = {x, y};
    point.normal = normal;
    points.push_back(point);
  }
  return points;
}

TEST(ExplainedEdges, AllOfAnEdgeThatTheMapHas) {
  EdgeMap edges = emptyMap();
  addEdge(edges, 100);
  EXPECT_EQ(explainedShare(edges, pointsAlong(20, 220, 101, {0, 1}), {}), 1);
}

TEST(ExplainedEdges, NoneOfAnotherEdge) {
  EdgeMap edges = emptyMap();
  addEdge(edges, 100);
  EXPECT_EQ(explainedShare(edges, pointsAlong(20, 220, 110, {0, 1}), {}), 0) << "beside it";
  EXPECT_EQ(explainedShare(edges, pointsAlong(20, 220, 100, {0, -1}), {}), 0) << "from bright to dark";
  EXPECT_EQ(explainedShare(edges, pointsAlong(20, 220, 100, {1, 0}), {}), 0) << "across it";
  EXPECT_EQ(explainedShare(edges, {}, {}), 0);
}

TEST(ExplainedEdges, HalfWhereHalfIsLeftOver) {
  EdgeMap edges = emptyMap();
  addEdge(edges, 60);
  addEdge(edges, 180);
  EXPECT_EQ(explainedShare(edges, pointsAlong(20, 220, 60, {0, 1}), {}), 0.5);
}

TEST(ExplainedEdges, NothingToExplain) {
  EXPECT_EQ(explainedShare(emptyMap(), pointsAlong(20, 220, 100, {0, 1}), {}), 0);
}

TEST(ExplainedEdges, PointsOutsideTheImageDoNoHarm) {
  EdgeMap edges = emptyMap();
  addEdge(edges, 2);
  EXPECT_GT(explainedShare(edges, pointsAlong(-100, 420, -1, {0, 1}), {}), 0.9);
}

}  // namespace
}  // namespace edgeslam::test
