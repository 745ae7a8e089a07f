// P19: what an adjustment says of the depths of its points, and that it says it of those alone that it saw.
#include <gtest/gtest.h>

#include <cmath>

#include "mapping/local_adjustment.h"
#include "unit/mapping/edge_scene.h"

namespace edgeslam {
namespace {

std::vector<Pose> beforeTheWall() {
  std::vector<Pose> poses;
  for (int i = 0; i < 6; ++i) poses.push_back({rotationExp({0.01 * i, -0.02 * i, 0}), {0.15 * i, 0.05 * (i % 3), 0}});
  return poses;
}

struct NoisyMap {
  test::EdgeScene scene = test::framesOnAWall(8);
  std::vector<Pose> truth = beforeTheWall();
  Map map;

  // Noise as the measurements state it. What the host saw is exact, as the adjustment takes it to be.
  explicit NoisyMap(std::uint64_t seed) {
    test::Random random(seed);
    test::Sight sight;
    sight.noise = 1;
    map = test::keyframesOf(test::distorted_camera, scene, truth, sight, random);
    test::addAllPoints(scene, map);
    for (auto& [id, point] : map.points) {
      const Eigen::Vector3d in_host = truth[static_cast<std::size_t>(point.host)].inverse() * positionOf(id);
      point.host_bearing = in_host.normalized();
    }
  }

  const Eigen::Vector3d& positionOf(PointId id) const { return scene.points[static_cast<std::size_t>(id)].position; }
  double trueInverseDepth(const MapPoint& point) const {
    return 1 / (truth[static_cast<std::size_t>(point.host)].inverse() * positionOf(point.id)).norm();
  }
};

// Whatever the deviations were before, afterwards they foretell how far the depths are off.
TEST(AdjustedDepths, AreOffByWhatTheirDeviationsSay) {
  for (const double sigma_before : {0.001, 0.3}) {
    double squares = 0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      NoisyMap noisy(seed);
      for (auto& [id, point] : noisy.map.points) point.inverse_depth_sigma = sigma_before * point.inverse_depth;
      ASSERT_TRUE(adjustKeyframes(test::distorted_camera, {}, {5}, {0, 1, 2, 3, 4}, noisy.map));
      for (const auto& [id, point] : noisy.map.points) {
        EXPECT_GT(point.inverse_depth_sigma, 0) << id;
        if (point.inverse_depth_sigma > 0.1 * point.inverse_depth) continue;  // not in proportion any more
        squares += std::pow((point.inverse_depth - noisy.trueInverseDepth(point)) / point.inverse_depth_sigma, 2);
        ++count;
      }
    }
    ASSERT_GT(count, 500);
    EXPECT_GT(squares / count, 0.7) << sigma_before;
    EXPECT_LT(squares / count, 1.4) << sigma_before;
  }
}

// More views, less doubt: a fourth of the variance from four times the views.
TEST(AdjustedDepths, DeviateLessTheMoreKeyframesSeeThePoint) {
  NoisyMap few(3), many(3);
  for (auto& [id, point] : few.map.points) point.seen_in = {point.seen_in.back()};
  ASSERT_TRUE(adjustKeyframes(test::distorted_camera, {}, {5}, {0, 1, 2, 3, 4}, few.map));
  ASSERT_TRUE(adjustKeyframes(test::distorted_camera, {}, {5}, {0, 1, 2, 3, 4}, many.map));
  int compared = 0;
  for (const auto& [id, point] : few.map.points) {
    const auto with_more = many.map.points.find(id);
    if (with_more == many.map.points.end() || with_more->second.seen_in.size() < 4) continue;
    EXPECT_LT(with_more->second.inverse_depth_sigma, 1.1 * point.inverse_depth_sigma) << id;
    ++compared;
  }
  EXPECT_GT(compared, 50);
}

// A point that none of the keyframes measured keeps its depth and its doubt.
TEST(AdjustedDepths, StayWhereNothingWasMeasured) {
  NoisyMap noisy(4);
  std::vector<PointId> unseen;
  for (auto& [id, point] : noisy.map.points) {
    const bool not_measured = id % 2 == 1;
    const KeyframeId host = not_measured ? 5 : 4;
    const PointObservation* seen = findObservation(noisy.map.keyframes[host], id);
    if (!seen) {
      point.seen_in.clear();
      continue;
    }
    point.host = host;
    point.host_bearing = (noisy.truth[static_cast<std::size_t>(host)].inverse() * noisy.positionOf(id)).normalized();
    point.inverse_depth = noisy.trueInverseDepth(point);
    point.inverse_depth_sigma = 0.123 * point.inverse_depth;
    point.seen_in = {not_measured ? 0 : 5};
    if (not_measured) unseen.push_back(id);
  }
  for (auto point = noisy.map.points.begin(); point != noisy.map.points.end();) {
    point = point->second.seen_in.empty() ? noisy.map.points.erase(point) : std::next(point);
  }
  ASSERT_GT(unseen.size(), 20U);
  const Map before = noisy.map;
  ASSERT_TRUE(adjustKeyframes(test::distorted_camera, {}, {5}, {4}, noisy.map));
  for (const PointId id : unseen) {
    ASSERT_EQ(noisy.map.points.count(id), 1U) << id;
    EXPECT_EQ(noisy.map.points.at(id).inverse_depth, before.points.at(id).inverse_depth) << id;
    EXPECT_EQ(noisy.map.points.at(id).inverse_depth_sigma, before.points.at(id).inverse_depth_sigma) << id;
  }
}

}  // namespace
}  // namespace edgeslam
