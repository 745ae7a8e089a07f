// P26: Horn's method gives the similarity between two sets of points.
#include "geometry/similarity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "unit/geometry/scene_fixture.h"

namespace edgeslam {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Similarity randomSimilarity(Random& random) {
  return {std::exp(random.uniform(-3, 3)), random.rotation(random.uniform(0, 3.1)), random.vector(20)};
}

Points randomPoints(Random& random, int count, const Eigen::Vector3d& size = {3, 3, 3}) {
  Points points;
  for (int i = 0; i < count; ++i) points.emplace_back(random.vector(1).cwiseProduct(size));
  return points;
}

Points transformed(const Similarity& similarity, const Points& points) {
  Points result;
  for (const Eigen::Vector3d& point : points) result.push_back(similarity * point);
  return result;
}

double squaredError(const Similarity& similarity, const Points& from, const Points& to) {
  double sum = 0;
  for (std::size_t i = 0; i < from.size(); ++i) sum += (similarity * from[i] - to[i]).squaredNorm();
  return sum;
}

TEST(Similarity, CompositionAndInverseActAsTransformations) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Similarity a = randomSimilarity(random), b = randomSimilarity(random);
    const Eigen::Vector3d point = random.vector(5);
    EXPECT_LT(((a * b) * point - a * (b * point)).norm(), 1e-11 * (1 + (a * (b * point)).norm()));
    EXPECT_LT((a.inverse() * (a * point) - point).norm(), 1e-10);
  }
}

TEST(AlignHorn, RecoversSimilarityExactly) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Similarity truth = randomSimilarity(random);
    const Points from =
        randomPoints(random, 3 + i % 20, i % 3 == 0 ? Eigen::Vector3d(3, 3, 0) : Eigen::Vector3d(3, 3, 3));
    const Similarity found = alignHorn(from, transformed(truth, from));
    EXPECT_NEAR(found.scale / truth.scale, 1, 1e-10);
    EXPECT_LT(rotationAngle(found.rotation, truth.rotation), 1e-6);
    EXPECT_LT((found.translation - truth.translation).norm(), 1e-8);
  }
}

TEST(AlignHorn, KeepsScaleAtOneWhenAsked) {
  Random random(3);
  const Similarity truth = randomSimilarity(random);
  const Points from = randomPoints(random, 30), to = transformed(truth, from);
  const Similarity found = alignHorn(from, to, false);
  EXPECT_EQ(found.scale, 1);
  EXPECT_LT(rotationAngle(found.rotation, truth.rotation), 1e-6);
  EXPECT_GT(squaredError(found, from, to), squaredError(alignHorn(from, to), from, to));
}

// The defining property: no neighbouring similarity has a smaller error.
TEST(AlignHorn, IsTheLeastSquaresMinimumUnderNoise) {
  Random random(4);
  for (const bool with_scale : {true, false}) {
    const Points from = randomPoints(random, 40);
    Points to = transformed(randomSimilarity(random), from);
    for (Eigen::Vector3d& point : to) point += random.vector(0.3);
    const Similarity found = alignHorn(from, to, with_scale);
    const double least = squaredError(found, from, to);
    for (int i = 0; i < 300; ++i) {
      Similarity other = found;
      if (with_scale) other.scale *= std::exp(random.normal(1e-3));
      other.rotation = other.rotation * random.rotation(1e-3);
      other.translation += random.vector(1e-3);
      EXPECT_GE(squaredError(other, from, to), least);
    }
  }
}

TEST(AlignHorn, MirroredPointsGiveAProperRotation) {
  Random random(5);
  const Points from = randomPoints(random, 20);
  Points to = from;
  for (Eigen::Vector3d& point : to) point.x() = -point.x();
  const Similarity found = alignHorn(from, to);
  EXPECT_NEAR(found.rotation.norm(), 1, 1e-12);
  EXPECT_GE(found.scale, 0);
  EXPECT_TRUE(found.translation.allFinite());
}

TEST(AlignHorn, DegenerateSetsStillFit) {
  Random random(6);
  const Similarity truth = randomSimilarity(random);
  const Points line = randomPoints(random, 10, {1, 0, 0}), on_line = transformed(truth, line);
  EXPECT_LT(squaredError(alignHorn(line, on_line), line, on_line), 1e-16 * (1 + std::pow(truth.scale, 2)));
  const Points two = randomPoints(random, 2), on_two = transformed(truth, two);
  EXPECT_LT(squaredError(alignHorn(two, on_two), two, on_two), 1e-16 * (1 + std::pow(truth.scale, 2)));
  for (const std::size_t count : {1, 2, 7}) {
    const Points here(count, Eigen::Vector3d(1, 2, 3)), there(count, Eigen::Vector3d(-4, 0.1, 1e6));
    const Similarity found = alignHorn(here, there);
    EXPECT_EQ(found.scale, 1);
    EXPECT_LT((found * here[0] - there[0]).norm(), 1e-9);
    const Points spread = randomPoints(random, static_cast<int>(count));
    EXPECT_TRUE(alignHorn(here, spread).translation.allFinite());
    EXPECT_TRUE(alignHorn(spread, here).translation.allFinite());
    EXPECT_GT(alignHorn(spread, here).scale, 0) << "so that it can be inverted";
  }
}

TEST(AlignHorn, PointsTooCloseForTheirVarianceAreOnlyMoved) {
  Random random(8);
  const Points target = randomPoints(random, 10);
  Points source;
  for (const Eigen::Vector3d& point : target) source.emplace_back(1e-170 * point);
  const Similarity found = alignHorn(source, target, true);
  EXPECT_EQ(found.scale, 1);
  for (const Eigen::Vector3d& point : source) EXPECT_TRUE((found * point).allFinite());
}

TEST(AlignHorn, RefusesSizesThatDifferOrAreZeroAndPointsThatAreNotFinite) {
  const Points one(1, Eigen::Vector3d::Zero()), two(2, Eigen::Vector3d::Zero());
  EXPECT_THROW(alignHorn({}, {}), std::invalid_argument);
  EXPECT_THROW(alignHorn(one, two), std::invalid_argument);
  EXPECT_THROW(alignHorn(two, {}), std::invalid_argument);
  Points wrong = two;
  wrong[1].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(alignHorn(two, wrong), std::invalid_argument);
  EXPECT_THROW(alignHorn(wrong, two, false), std::invalid_argument);
}

}  // namespace
}  // namespace edgeslam
