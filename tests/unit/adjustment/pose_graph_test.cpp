// P27: drift is shared out over a pose graph.
#include "adjustment/pose_graph.h"

#include <gtest/gtest.h>

#include <limits>

#include "unit/adjustment/synthetic_scene.h"

namespace edgeslam {
namespace {

std::vector<Similarity> circle(int count) {
  std::vector<Similarity> nodes;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * M_PI * k / count;
    nodes.push_back({1, rotationExp({0, -angle, 0}), {3 * std::sin(angle), 0, 3 - 3 * std::cos(angle)}});
  }
  return nodes;
}

// Edges between neighbours, as measured with `error` in each; nodes put one after the other by them.
PoseGraph chain(const std::vector<Similarity>& truth, const Similarity& error) {
  PoseGraph graph;
  graph.nodes.push_back({truth.front(), true});
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const Similarity motion = truth[k - 1].inverse() * truth[k] * error;
    graph.nodes.push_back({graph.nodes.back().world_S_node * motion, false});
    graph.edges.push_back({static_cast<int>(k) - 1, static_cast<int>(k), motion, 1.0});
  }
  return graph;
}

double largestError(const PoseGraph& graph, const std::vector<Similarity>& truth) {
  double largest = 0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const Similarity& node = graph.nodes[k].world_S_node;
    largest =
        std::max({largest, (node.translation - truth[k].translation).norm(),
                  rotationAngle(node.rotation, truth[k].rotation), std::abs(std::log(node.scale / truth[k].scale))});
  }
  return largest;
}

void closeLoop(PoseGraph& graph, const std::vector<Similarity>& truth, double weight) {
  const int last = static_cast<int>(truth.size()) - 1;
  graph.edges.push_back({last, 0, truth.back().inverse() * truth.front(), weight});
}

TEST(PoseGraph, PerturbedNodesReturnWhereTheEdgesAgree) {
  const std::vector<Similarity> truth = circle(20);
  PoseGraph graph = chain(truth, {});
  closeLoop(graph, truth, 1);
  test::Random random(3);
  for (std::size_t k = 1; k < graph.nodes.size(); ++k) {
    const Pose shift = test::randomPose(random, 0.3, 0.2);
    graph.nodes[k].world_S_node =
        graph.nodes[k].world_S_node * Similarity{test::uniform(random, 0.8, 1.25), shift.rotation, shift.translation};
  }
  ASSERT_GT(largestError(graph, truth), 0.2);
  const PoseGraphResult result = optimisePoseGraph(graph, 50);
  EXPECT_TRUE(result.usable);
  EXPECT_LT(result.final_cost, 1e-10);
  EXPECT_LT(largestError(graph, truth), 1e-4);
}

TEST(PoseGraph, DriftedCircleCloses) {
  const std::vector<Similarity> truth = circle(40);
  const Similarity error{1.006, rotationExp({0.002, 0.004, -0.002}), {0.003, 0, 0.002}};
  PoseGraph graph = chain(truth, error);
  const double drift = (graph.nodes.back().world_S_node.translation - truth.back().translation).norm();
  ASSERT_GT(drift, 0.5);
  const double before = largestError(graph, truth);
  closeLoop(graph, truth, 10);
  ASSERT_TRUE(optimisePoseGraph(graph, 50).usable);
  EXPECT_LT((graph.nodes.back().world_S_node.translation - truth.back().translation).norm(), 0.05 * drift);
  EXPECT_LT(largestError(graph, truth), 0.3 * before);
}

TEST(PoseGraph, ScaleDriftIsSharedOut) {
  const std::vector<Similarity> truth = circle(30);
  PoseGraph graph = chain(truth, {1.01, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero()});
  ASSERT_GT(graph.nodes.back().world_S_node.scale, 1.3);
  closeLoop(graph, truth, 10);
  ASSERT_TRUE(optimisePoseGraph(graph, 50).usable);
  for (const PoseGraphNode& node : graph.nodes) EXPECT_NEAR(std::log(node.world_S_node.scale), 0, 0.06);
}

TEST(PoseGraph, FixedNodesStay) {
  const std::vector<Similarity> truth = circle(10);
  PoseGraph graph = chain(truth, {1.02, rotationExp({0, 0.02, 0}), {0.01, 0, 0}});
  graph.nodes[4].fixed = true;
  closeLoop(graph, truth, 5);
  const PoseGraph before = graph;
  ASSERT_TRUE(optimisePoseGraph(graph, 30).usable);
  for (const std::size_t k : {0u, 4u}) {
    EXPECT_EQ(graph.nodes[k].world_S_node.translation, before.nodes[k].world_S_node.translation);
    EXPECT_EQ(graph.nodes[k].world_S_node.rotation.coeffs(), before.nodes[k].world_S_node.rotation.coeffs());
    EXPECT_EQ(graph.nodes[k].world_S_node.scale, before.nodes[k].world_S_node.scale);
  }
}

TEST(PoseGraph, WhatIsKnownIsKeptWhateverTheLoopSays) {
  const std::vector<Similarity> truth = circle(30);
  const Similarity drift{1, rotationExp({0, 0.004, 0}), {0.004, 0.002, 0.003}};  // about y, which is up
  PoseGraph graph = chain(truth, drift);
  graph.keeps_scale = true;
  graph.up = Eigen::Vector3d(0, -1, 0);
  closeLoop(graph, truth, 10);
  // The loop is measured wrongly where nothing can be wrong.
  Similarity& loop = graph.edges.back().from_S_to;
  loop.rotation = loop.rotation * rotationExp({0.05, 0, 0.03});
  const PoseGraph before = graph;
  const double off = (graph.nodes.back().world_S_node.translation - truth.back().translation).norm();
  ASSERT_GT(off, 0.1);
  ASSERT_TRUE(optimisePoseGraph(graph, 50).usable);
  EXPECT_LT((graph.nodes.back().world_S_node.translation - truth.back().translation).norm(), 0.1 * off);
  double largest_turn = 0;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const Similarity& is = graph.nodes[k].world_S_node;
    const Similarity& was = before.nodes[k].world_S_node;
    EXPECT_EQ(is.scale, was.scale);
    const Eigen::Vector3d up_before = was.rotation.conjugate() * *graph.up;
    EXPECT_LT((is.rotation.conjugate() * *graph.up - up_before).norm(), 1e-12);
    largest_turn = std::max(largest_turn, rotationAngle(is.rotation, was.rotation));
  }
  EXPECT_GT(largest_turn, 0.05);
}

TEST(PoseGraph, ScaleAloneMayBeKnown) {
  const std::vector<Similarity> truth = circle(30);
  PoseGraph graph = chain(truth, {1, rotationExp({0.002, 0.004, 0.001}), {0.004, 0.002, 0.003}});
  graph.keeps_scale = true;
  closeLoop(graph, truth, 10);
  graph.edges.back().from_S_to.scale = 1.1;
  const double before = largestError(graph, truth);
  ASSERT_TRUE(optimisePoseGraph(graph, 50).usable);
  EXPECT_LT(largestError(graph, truth), 0.4 * before);
  for (const PoseGraphNode& node : graph.nodes) EXPECT_EQ(node.world_S_node.scale, 1);
}

TEST(PoseGraph, SameInputSameBits) {
  const std::vector<Similarity> truth = circle(25);
  PoseGraph a = chain(truth, {1.01, rotationExp({0, 0.01, 0.003}), {0.01, 0, 0}});
  closeLoop(a, truth, 10);
  PoseGraph b = a;
  optimisePoseGraph(a, 30);
  optimisePoseGraph(b, 30);
  for (std::size_t k = 0; k < a.nodes.size(); ++k) {
    EXPECT_EQ(a.nodes[k].world_S_node.translation, b.nodes[k].world_S_node.translation);
    EXPECT_EQ(a.nodes[k].world_S_node.scale, b.nodes[k].world_S_node.scale);
  }
}

TEST(PoseGraph, WhatIsNoGraphIsRefusedAndLeftAlone) {
  const std::vector<Similarity> truth = circle(6);
  const PoseGraph good = chain(truth, {1.01, Eigen::Quaterniond::Identity(), {0.01, 0, 0}});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<PoseGraph> bad(11, good);
  bad[0].nodes[0].fixed = false;  // nothing holds it
  bad[1].edges[2].to = 6;
  bad[2].edges[2].from = -1;
  bad[3].nodes[3].world_S_node.translation.x() = nan;
  bad[4].edges[1].from_S_to.scale = 0;
  bad[5].edges[1].weight = nan;
  bad[6].length = 0;
  bad[7].length = -1;
  bad[8].length = std::numeric_limits<double>::infinity();
  bad[9].up = Eigen::Vector3d(0, 0, 2);
  bad[10].up = Eigen::Vector3d(0, nan, 1);
  for (PoseGraph& graph : bad) {
    EXPECT_FALSE(optimisePoseGraph(graph, 10).usable);
    EXPECT_EQ(graph.nodes[5].world_S_node.translation, good.nodes[5].world_S_node.translation);
  }
  PoseGraph empty;
  EXPECT_FALSE(optimisePoseGraph(empty, 10).usable);
}

}  // namespace
}  // namespace edgeslam
