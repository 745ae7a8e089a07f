// P26: the similarity between two sides of a loop is found among wrong pairs, and refined.
#include "places/similarity_estimation.h"

#include <gtest/gtest.h>

#include <numeric>

#include "unit/adjustment/synthetic_scene.h"

namespace edgeslam {
namespace {

using test::Random;
using test::uniform;

Similarity randomSimilarity(Random& random) {
  const Pose pose = test::randomPose(random, 0.5, 0.4);
  return {std::exp(uniform(random, -0.7, 0.7)), pose.rotation, pose.translation};
}

// Points seen by both cameras, measured with edges of every direction, of which the first `wrong` are paired wrongly.
std::vector<PlaceCorrespondence> makePairs(Random& random, const Camera& camera, const Similarity& current_S_candidate,
                                           int count, int wrong, double noise) {
  std::vector<PlaceCorrespondence> pairs;
  while (static_cast<int>(pairs.size()) < count) {
    PlaceCorrespondence pair;
    pair.paired = true;
    pair.candidate_point = bearing(camera, test::randomPixel(random, camera)) * uniform(random, 2, 6);
    pair.current_point = current_S_candidate * pair.candidate_point;
    if (!inFront(camera, pair.current_point)) continue;
    const Eigen::Vector2d here = project(camera, pair.current_point), there = project(camera, pair.candidate_point);
    if (!insideImage(camera, here)) continue;
    const bool corner = pairs.size() % 3 == 0;
    pair.in_current = test::measure(random, here, uniform(random, 0, 6), corner ? 0.2 : 0.5, corner ? 0.4 : 6, noise);
    pair.in_candidate =
        test::measure(random, there, uniform(random, 0, 6), corner ? 0.2 : 0.5, corner ? 0.4 : 6, noise);
    pair.depth_deviation = 0.03;
    pair.current_point *= std::exp(test::gaussian(random, 0.1 * noise * pair.depth_deviation));
    if (static_cast<int>(pairs.size()) < wrong) {
      pair.current_point = bearing(camera, test::randomPixel(random, camera)) * uniform(random, 2, 6);
      pair.in_current.pixel = project(camera, pair.current_point);
    }
    pairs.push_back(pair);
  }
  return pairs;
}

void expectNear(const Similarity& is, const Similarity& should_be, double angle, double distance, double log_scale) {
  EXPECT_LT(rotationAngle(is.rotation, should_be.rotation), angle);
  EXPECT_LT((is.translation - should_be.translation).norm(), distance);
  EXPECT_LT(std::abs(std::log(is.scale / should_be.scale)), log_scale);
}

class SimilarityOfBothModels : public testing::TestWithParam<CameraModel> {};

TEST_P(SimilarityOfBothModels, IsFoundAmongAsManyWrongPairs) {
  const Camera camera = test::testCamera(GetParam());
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    const Similarity truth = randomSimilarity(random);
    const int wrong = 60;
    const std::vector<PlaceCorrespondence> pairs = makePairs(random, camera, truth, 120, wrong, 0.5);
    const SimilarityEstimate estimate = estimateSimilarity(camera, pairs, 3, 30, 400, seed);
    ASSERT_TRUE(estimate.found) << "seed " << seed;
    expectNear(estimate.current_S_candidate, truth, 0.004, 0.03 * truth.scale, 0.02);
    ASSERT_EQ(estimate.inliers.size(), pairs.size());
    EXPECT_EQ(std::accumulate(estimate.inliers.begin(), estimate.inliers.end(), 0), estimate.inlier_count);
    EXPECT_EQ(std::accumulate(estimate.inliers.begin(), estimate.inliers.begin() + wrong, 0), 0);
    EXPECT_GE(estimate.inlier_count, 57);
  }
}

TEST_P(SimilarityOfBothModels, IsExactWithoutNoise) {
  const Camera camera = test::testCamera(GetParam());
  Random random(9);
  const Similarity truth = randomSimilarity(random);
  const SimilarityEstimate estimate =
      estimateSimilarity(camera, makePairs(random, camera, truth, 40, 0, 0), 3, 30, 50, 1);
  ASSERT_TRUE(estimate.found);
  EXPECT_EQ(estimate.inlier_count, 40);
  expectNear(estimate.current_S_candidate, truth, 1e-6, 1e-6, 1e-6);
}

TEST_P(SimilarityOfBothModels, RefinementLeadsBackFromNearby) {
  const Camera camera = test::testCamera(GetParam());
  Random random(11);
  const Similarity truth = randomSimilarity(random);
  std::vector<PlaceCorrespondence> pairs = makePairs(random, camera, truth, 80, 0, 0);
  for (std::size_t i = 0; i < pairs.size(); i += 2) pairs[i].paired = false;
  Similarity start = truth * Similarity{1.1, rotationExp({0.02, -0.03, 0.01}), {0.05, 0.02, -0.04}};
  expectNear(refineSimilarity(camera, pairs, start, 1.5, 40), truth, 1e-6, 1e-6, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Models, SimilarityOfBothModels,
                         testing::Values(CameraModel::pinhole_radial_tangential, CameraModel::kannala_brandt));

TEST(SimilarityEstimation, FindsNothingAmongWrongPairs) {
  const Camera camera = test::testCamera(CameraModel::pinhole_radial_tangential);
  Random random(2);
  const std::vector<PlaceCorrespondence> pairs = makePairs(random, camera, {}, 80, 80, 0);
  EXPECT_FALSE(estimateSimilarity(camera, pairs, 3, 15, 400, 5).found);
  EXPECT_FALSE(estimateSimilarity(camera, {}, 3, 1, 400, 5).found);
}

TEST(SimilarityEstimation, SameSeedSameBits) {
  const Camera camera = test::testCamera(CameraModel::pinhole_radial_tangential);
  Random random(4);
  const std::vector<PlaceCorrespondence> pairs = makePairs(random, camera, randomSimilarity(random), 90, 30, 0.5);
  const SimilarityEstimate a = estimateSimilarity(camera, pairs, 3, 30, 200, 8),
                           b = estimateSimilarity(camera, pairs, 3, 30, 200, 8);
  EXPECT_EQ(a.current_S_candidate.scale, b.current_S_candidate.scale);
  EXPECT_EQ(a.current_S_candidate.rotation.coeffs(), b.current_S_candidate.rotation.coeffs());
  EXPECT_EQ(a.inliers, b.inliers);
}

TEST(SimilarityEstimation, EachOfTheThreeErrorsCounts) {
  const Camera camera = test::testCamera(CameraModel::pinhole_radial_tangential);
  Random random(6);
  const PlaceCorrespondence good = makePairs(random, camera, {}, 1, 0, 0).front();
  EXPECT_LT(correspondenceError(camera, good, {}), 1e-6);
  PlaceCorrespondence moved = good;
  moved.in_current.pixel += 10 * good.in_current.sigma_normal * good.in_current.normal;
  EXPECT_NEAR(correspondenceError(camera, moved, {}), 10, 1e-6);
  moved = good;
  moved.in_candidate.pixel += 7 * good.in_candidate.sigma_normal * good.in_candidate.normal;
  EXPECT_NEAR(correspondenceError(camera, moved, {}), 7, 1e-6);
  moved = good;
  moved.current_point *= std::exp(5 * good.depth_deviation);
  EXPECT_NEAR(correspondenceError(camera, moved, {}), 5, 1e-6);
  moved.paired = false;
  EXPECT_LT(correspondenceError(camera, moved, {}), 1e-6);
  moved.candidate_point *= -1;
  EXPECT_TRUE(std::isinf(correspondenceError(camera, moved, {})));
}

}  // namespace
}  // namespace edgeslam
