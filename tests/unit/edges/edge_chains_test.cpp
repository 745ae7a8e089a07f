// P3: edge points are joined along the edge into chains.
#include "edges/edge_chains.h"

#include <gtest/gtest.h>

#include "unit/edges/synthetic_image.h"

namespace edgeslam {
namespace {

struct Points {
  EdgeWorkspace workspace;
  cv::Mat index = cv::Mat(40, 60, CV_32S, cv::Scalar(-1));

  void add(int x, int y, const Eigen::Vector2f& normal) {
    std::vector<EdgePixel>& points = workspace.pixels.points;
    index.at<int>(y, x) = static_cast<int>(points.size());
    EdgePixel point;
    point.pixel = {static_cast<float>(x), static_cast<float>(y)};
    point.normal = normal;
    point.cell = {x, y};
    points.push_back(point);
  }
};

EdgeMap join(Points input, int shortest = 6) {
  EdgeMap edges;
  edges.index = input.index.clone();
  joinChains(shortest, input.workspace, edges);
  return edges;
}

// What holds for every edge map.
void expectConsistent(const EdgeMap& edges, int shortest) {
  std::vector<int> lengths(static_cast<size_t>(edges.chain_count), 0);
  int named = 0;
  for (int y = 0; y < edges.index.rows; ++y) {
    for (int x = 0; x < edges.index.cols; ++x) {
      const int index = edges.index.at<int>(y, x);
      if (index < 0) continue;
      ++named;
      const EdgePoint& point = edges.points.at(static_cast<size_t>(index));
      EXPECT_LT((point.pixel - Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y))).norm(), 0.72F);
    }
  }
  EXPECT_EQ(named, static_cast<int>(edges.points.size()));
  for (int i = 0; i < static_cast<int>(edges.points.size()); ++i) {
    const EdgePoint& point = edges.points[static_cast<size_t>(i)];
    ASSERT_GE(point.chain, 0);
    ASSERT_LT(point.chain, edges.chain_count);
    ++lengths[static_cast<size_t>(point.chain)];
    if (i > 0) {
      EXPECT_GE(point.chain, edges.points[static_cast<size_t>(i - 1)].chain);
    }
    if (point.next >= 0) {
      const EdgePoint& next = edges.points.at(static_cast<size_t>(point.next));
      EXPECT_EQ(next.previous, i);
      EXPECT_EQ(next.chain, point.chain);
      // Along the edge in the direction of `next`, a quarter turn from the normal.
      EXPECT_GT((next.pixel - point.pixel).dot(Eigen::Vector2f(-point.normal.y(), point.normal.x())), 0);
      if (point.next != i + 1) {
        EXPECT_LT(point.next, i) << "only a closed chain's last point leads back";
        EXPECT_EQ(edges.points.at(static_cast<size_t>(point.next)).previous, i);
      }
    }
    if (point.previous >= 0) {
      EXPECT_EQ(edges.points.at(static_cast<size_t>(point.previous)).next, i);
    }
  }
  for (const int length : lengths) EXPECT_GE(length, shortest);
}

TEST(EdgeChains, LinksAreMutualAndInOrder) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const cv::Mat image = withNoise(renderTexture(cv::Size(200, 150), seed), 2, seed);
    EdgeOptions options;
    for (const int shortest : {1, 6, 20}) {
      options.shortest_chain = shortest;
      const EdgeMap edges = detectEdges(image, options);
      ASSERT_GT(edges.chain_count, 10);
      expectConsistent(edges, shortest);
    }
  }
}

TEST(EdgeChains, ShorterChainsAreDropped) {
  Points input;
  for (int y = 10; y < 15; ++y) input.add(10, y, {1, 0});
  for (int y = 10; y < 16; ++y) input.add(30, y, {1, 0});
  const EdgeMap edges = join(input, 6);
  EXPECT_EQ(edges.chain_count, 1);
  ASSERT_EQ(edges.points.size(), 6U);
  EXPECT_EQ(edges.points[0].pixel, Eigen::Vector2f(30, 10));
  EXPECT_EQ(edges.index.at<int>(10, 10), -1);
  EXPECT_EQ(edges.index.at<int>(12, 30), 2);
  expectConsistent(edges, 6);
}

TEST(EdgeChains, NormalsThatDisagreeAreNotJoined) {
  Points input;
  for (int y = 5; y < 15; ++y) input.add(10, y, {1, 0});
  for (int y = 15; y < 25; ++y) input.add(10, y, {-1, 0});
  const EdgeMap edges = join(input);
  EXPECT_EQ(edges.chain_count, 2);
  expectConsistent(edges, 6);
}

TEST(EdgeChains, JunctionCutsTheSideBranchOnly) {
  Points input;
  for (int y = 5; y < 35; ++y) input.add(30, y, {1, 0});
  const Eigen::Vector2f oblique = Eigen::Vector2f(1, -1).normalized();
  for (int i = 1; i < 12; ++i) input.add(30 - i, 20 - i, oblique);
  const EdgeMap edges = join(input);
  ASSERT_EQ(edges.chain_count, 2);
  ASSERT_EQ(edges.points.size(), 41U);
  // The upright line starts higher up, so its chain comes first.
  for (int i = 0; i < 30; ++i) {
    EXPECT_EQ(edges.points[static_cast<size_t>(i)].pixel, Eigen::Vector2f(30.0F, 5.0F + static_cast<float>(i)));
  }
  expectConsistent(edges, 6);
}

TEST(EdgeChains, PointsThatTheIndexDoesNotNameAreLeftOut) {
  Points input;
  for (int y = 5; y < 25; ++y) input.add(10, y, {1, 0});
  input.index.at<int>(15, 10) = -1;
  const EdgeMap edges = join(input);
  EXPECT_EQ(edges.chain_count, 2);
  EXPECT_EQ(edges.points.size(), 19U);
  expectConsistent(edges, 6);
}

TEST(EdgeChains, NothingGivesNothing) {
  const EdgeMap edges = join(Points());
  EXPECT_TRUE(edges.points.empty());
  EXPECT_EQ(edges.chain_count, 0);
}

}  // namespace
}  // namespace edgeslam
