// Straight lines in bundle adjustment: a house is found from its edges, with the errors that it should have, and lines
// of which too little is seen harm nothing.
#include "adjustment/bundle_lines.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>

#include "synthetic_house.h"

namespace edgeslam::test {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite_value = std::numeric_limits<double>::infinity();

void expectTruth(const BundleProblem& problem, const BundleProblem& truth) {
  EXPECT_LT(largestTranslationError(problem, truth), 1e-5);
  EXPECT_LT(largestRotationError(problem, truth), 1e-5);
  EXPECT_LT(largestLineError(problem, truth), 1e-5);
  EXPECT_LT(largestDepthError(problem, truth), 1e-5);
}

bool isCovariance(const Eigen::Matrix4d& matrix) {
  return matrix.allFinite() && matrix.isApprox(matrix.transpose(), 1e-6) && (matrix.diagonal().array() > 0).all();
}

class BundleOfHouse : public testing::TestWithParam<int> {};

TEST_P(BundleOfHouse, ExactViewsBringItBackToTheTruth) {
  Random random(1);
  for (int run = 0; run < 10; ++run) {
    HouseOptions options;
    options.points = GetParam();
    const BundleScene house = makeHouse(random, options);
    BundleProblem problem = perturbedHouse(random, house.truth);
    EXPECT_GT(largestLineError(problem, house.truth), 0.05);
    const BundleResult result = adjustBundle(house.camera, problem, manyIterations());
    ASSERT_TRUE(result.usable);
    expectTruth(problem, house.truth);
    EXPECT_GT(result.initial_cost, 1000);
    EXPECT_LT(result.final_cost, 1e-5);
    ASSERT_EQ(result.line_errors.size(), problem.line_observations.size());
    for (const double error : result.line_errors) EXPECT_LT(error, 0.01);
    ASSERT_EQ(result.line_covariances.size(), problem.lines.size());
    for (const Eigen::Matrix4d& covariance : result.line_covariances) EXPECT_TRUE(isCovariance(covariance));
  }
}

TEST_P(BundleOfHouse, NoiseGivesTheErrorThatItShould) {
  Random random(2);
  constexpr int runs = 20;
  double cost_ratio = 0, line_nees = 0, translation_error = 0, rotation_error = 0, line_error = 0;
  for (int run = 0; run < runs; ++run) {
    HouseOptions options;
    options.points = GetParam();
    options.noise = 1;
    const BundleScene house = makeHouse(random, options);
    BundleProblem problem = perturbedHouse(random, house.truth);
    BundleOptions quadratic = manyIterations();
    quadratic.huber = 1e3;
    const BundleResult result = adjustBundle(house.camera, problem, quadratic);
    ASSERT_TRUE(result.usable);
    const auto lines = static_cast<double>(problem.lines.size()), points = static_cast<double>(problem.points.size());
    const double residuals =
        static_cast<double>(problem.line_observations.size()) + 2 * static_cast<double>(problem.observations.size());
    cost_ratio += result.final_cost / (0.5 * (residuals - 6 * 6 - 4 * lines - points)) / runs;
    translation_error += largestTranslationError(problem, house.truth) / runs;
    rotation_error += largestRotationError(problem, house.truth) / runs;
    line_error += largestLineError(problem, house.truth) / runs;
    // Lines with exact poses: their covariance is the one given.
    BundleProblem held = house.truth;
    for (BundleCamera& c : held.cameras) c.fixed = true;
    const BundleResult held_result = adjustBundle(house.camera, held, quadratic);
    ASSERT_TRUE(held_result.usable);
    for (std::size_t i = 0; i < held.lines.size(); ++i) {
      const Eigen::Vector4d error = changeBetween(held.lines[i].line, house.truth.lines[i].line);
      line_nees += error.dot(held_result.line_covariances[i].ldlt().solve(error)) / lines / runs;
    }
  }
  EXPECT_NEAR(cost_ratio, 1, 0.05);
  EXPECT_NEAR(line_nees, 4, 0.6);
  EXPECT_LT(translation_error, 0.02);
  EXPECT_LT(rotation_error, 0.004);
  EXPECT_LT(line_error, 0.01);
}

TEST_P(BundleOfHouse, KeepsTheScaleWhereOnlyOneCameraIsFixed) {
  Random random(3);
  HouseOptions options;
  options.points = GetParam();
  BundleScene house = makeHouse(random, options);
  house.truth.cameras[1].fixed = false;
  BundleProblem problem = perturbedHouse(random, house.truth);
  problem.scale_camera = 4;
  const auto baseline = [](const BundleProblem& p) {
    return (p.cameras[4].world_T_camera.translation - p.cameras[0].world_T_camera.translation).norm();
  };
  const double before = baseline(problem);
  ASSERT_TRUE(adjustBundle(house.camera, problem, manyIterations()).usable);
  EXPECT_NEAR(baseline(problem), before, 1e-12);
  // The truth at the scale of the start.
  const double scale = before / baseline(house.truth);
  EXPECT_GT(std::abs(scale - 1), 1e-3);
  BundleProblem expected = house.truth;
  const Eigen::Vector3d origin = expected.cameras[0].world_T_camera.translation;
  const auto scaled = [&](const Eigen::Vector3d& x) { return Eigen::Vector3d(origin + scale * (x - origin)); };
  for (BundleCamera& c : expected.cameras) c.world_T_camera.translation = scaled(c.world_T_camera.translation);
  for (BundlePoint& p : expected.points) p.inverse_depth /= scale;
  for (BundleLine& l : expected.lines) l.line.point = scaled(l.line.point);
  expectTruth(problem, expected);
}

INSTANTIATE_TEST_SUITE_P(Points, BundleOfHouse, testing::Values(0, 60));

TEST(BundleLines, ManyCamerasTakeTheSparseWayToTheSameEnd) {
  Random random(4);
  HouseOptions options;
  options.cameras = 36;
  const BundleScene house = makeHouse(random, options);
  BundleProblem problem = perturbedHouse(random, house.truth);
  ASSERT_TRUE(adjustBundle(house.camera, problem, manyIterations()).usable);
  expectTruth(problem, house.truth);
}

TEST(BundleLines, RowsThatMoveAreWhereTheyWere) {
  Random random(5);
  BundleScene house = makeHouse(random, {});
  house.camera.readout_s = 0.03;
  for (BundleCamera& c : house.truth.cameras) c.twist << uniformVector(random, 1), uniformVector(random, 1);
  for (BundleLineObservation& o : house.truth.line_observations) {
    o.row = uniform(random, 0, house.camera.height - 1);
    const BundleCamera& c = house.truth.cameras[static_cast<std::size_t>(o.camera)];
    const Eigen::Vector3d& end = house.truth.lines[static_cast<std::size_t>(o.line)].line.point;
    o.bearing = (worldTRow(house.camera, {c.world_T_camera, c.twist}, o.row).inverse() *
                 (end + uniform(random, -1, 1) * house.truth.lines[static_cast<std::size_t>(o.line)].line.direction))
                    .normalized();
  }
  BundleProblem problem = perturbedHouse(random, house.truth), as_global_shutter = problem;
  const BundleResult result = adjustBundle(house.camera, problem, manyIterations());
  ASSERT_TRUE(result.usable);
  expectTruth(problem, house.truth);
  for (const double error : result.line_errors) EXPECT_LT(error, 0.01);
  house.camera.readout_s = 0;
  EXPECT_GT(adjustBundle(house.camera, as_global_shutter, manyIterations()).final_cost, 100);
}

TEST(BundleLines, OutliersAreSuppressed) {
  Random random(6);
  double error = 0, error_as_if_none = 0;
  for (int run = 0; run < 10; ++run) {
    HouseOptions options;
    options.noise = 1;
    BundleScene house = makeHouse(random, options);
    for (std::size_t k = 0; k < house.truth.line_observations.size(); k += 13) {
      BundleLineObservation& o = house.truth.line_observations[k];
      o.bearing = (o.bearing + 0.05 * direction(random)).normalized();
    }
    BundleProblem problem = perturbedHouse(random, house.truth), as_if_none = problem;
    ASSERT_TRUE(adjustBundle(house.camera, problem, manyIterations()).usable);
    error += largestLineError(problem, house.truth);
    BundleOptions quadratic = manyIterations();
    quadratic.huber = 1e3;
    ASSERT_TRUE(adjustBundle(house.camera, as_if_none, quadratic).usable);
    error_as_if_none += largestLineError(as_if_none, house.truth);
  }
  EXPECT_LT(error, 0.3 * error_as_if_none);
}

TEST(BundleLines, FixedOnesStayToTheLastBitAndHoldTheScale) {
  Random random(7);
  HouseOptions options;
  options.noise = 1;
  BundleScene house = makeHouse(random, options);
  house.truth.cameras[1].fixed = false;
  for (std::size_t i = 0; i < house.truth.lines.size(); i += 3) house.truth.lines[i].fixed = true;
  BundleProblem problem = perturbedHouse(random, house.truth);
  problem.scale_camera = 4;  // and are not scaled either
  const BundleProblem before = problem;
  ASSERT_TRUE(adjustBundle(house.camera, problem, manyIterations()).usable);
  for (std::size_t i = 0; i < problem.lines.size(); ++i) {
    EXPECT_EQ(problem.lines[i].line.point == before.lines[i].line.point, before.lines[i].fixed) << i;
    EXPECT_EQ(problem.lines[i].line.direction == before.lines[i].line.direction, before.lines[i].fixed) << i;
  }
  EXPECT_LT(largestTranslationError(problem, house.truth), 0.03);
}

TEST(BundleLines, OnlyCamerasOrOnlyLinesFree) {
  Random random(8);
  const BundleScene house = makeHouse(random, {});
  BundleProblem truth = house.truth;
  for (BundleLine& line : truth.lines) line.fixed = true;
  BundleProblem problem = perturbedHouse(random, truth);
  ASSERT_TRUE(adjustBundle(house.camera, problem, manyIterations()).usable);
  expectTruth(problem, truth);

  truth = house.truth;
  for (BundleCamera& c : truth.cameras) c.fixed = true;
  problem = perturbedHouse(random, truth);
  ASSERT_TRUE(adjustBundle(house.camera, problem, manyIterations()).usable);
  expectTruth(problem, truth);

  for (BundleLine& line : truth.lines) line.fixed = true;
  problem = truth;
  EXPECT_FALSE(adjustBundle(house.camera, problem, manyIterations()).usable);
  EXPECT_TRUE(sameLines(problem, truth));
}

TEST(BundleLines, SameInputSameBytes) {
  Random random(9);
  for (const int cameras : {8, 36}) {
    HouseOptions options;
    options.cameras = cameras;
    options.points = 20;
    options.noise = 1;
    const BundleScene house = makeHouse(random, options);
    BundleProblem first = perturbedHouse(random, house.truth), second = first;
    const BundleResult first_result = adjustBundle(house.camera, first, {});
    const std::vector<double> elsewhere(100003, 1.0);
    const BundleResult second_result = adjustBundle(house.camera, second, {});
    ASSERT_TRUE(first_result.usable);
    EXPECT_TRUE(sameBytes(first, second) && sameLines(first, second));
    EXPECT_EQ(first_result.line_errors, second_result.line_errors);
    EXPECT_EQ(first_result.line_covariances, second_result.line_covariances);
  }
}

// Lines that nothing is seen of change nothing, to the last bit.
TEST(BundleLines, UnseenOnesLeaveTheResultAsItWas) {
  Random random(10);
  for (const int cameras : {6, 40}) {
    BundleSceneOptions options;
    options.cameras = cameras;
    options.noise = 1;
    const BundleScene scene = makeBundleScene(random, options);
    BundleProblem without = perturbedProblem(random, scene.truth, 0.05, 0.02), with = without;
    for (const HouseEdge& edge : houseEdges()) with.lines.push_back({{edge.middle, edge.half.normalized()}});
    const BundleProblem before = with;
    const BundleResult result_without = adjustBundle(scene.camera, without, {});
    const BundleResult result_with = adjustBundle(scene.camera, with, {});
    ASSERT_TRUE(result_without.usable);
    EXPECT_TRUE(sameBytes(without, with));
    EXPECT_TRUE(sameLines(with, before));
    EXPECT_EQ(result_without.errors, result_with.errors);
    EXPECT_EQ(result_without.depth_sigmas, result_with.depth_sigmas);
    EXPECT_EQ(result_without.final_cost, result_with.final_cost);
    for (const Eigen::Matrix4d& covariance : result_with.line_covariances) EXPECT_TRUE(covariance.isZero(0));
  }
}

// A house and a line beside it, seen by some of its cameras.
struct OddLine {
  BundleScene house;
  std::size_t line = 0, first_observation = 0;
};

OddLine withOddLine(Random& random, const BundleScene& house, const SpaceLine& line, const std::vector<int>& cameras) {
  OddLine made{house, house.truth.lines.size(), house.truth.line_observations.size()};
  BundleProblem& problem = made.house.truth;
  problem.lines.push_back({line});
  for (const int camera : cameras)
    addEdgeView(random, {line.point, line.direction}, camera, static_cast<int>(made.line), 0, problem);
  return made;
}

const Eigen::Vector3d& centreOf(const BundleScene& house, std::size_t camera) {
  return house.truth.cameras[camera].world_T_camera.translation;
}

// Cameras and the house's own lines end at the truth, all of it finite; what became of the odd line.
BundleResult adjustBesideOddLine(Random& random, const OddLine& odd, BundleProblem& problem) {
  problem = perturbedHouse(random, odd.house.truth);
  const BundleResult result = adjustBundle(odd.house.camera, problem, manyIterations());
  EXPECT_TRUE(result.usable);
  const std::size_t line = odd.line;
  EXPECT_TRUE(problem.lines[line].line.point.allFinite());
  EXPECT_NEAR(problem.lines[line].line.direction.norm(), 1, 1e-9);
  EXPECT_TRUE(isCovariance(result.line_covariances[line]));
  EXPECT_TRUE(std::isfinite(result.final_cost));
  BundleProblem others = problem, truth = odd.house.truth;
  others.lines.resize(line);
  truth.lines.resize(line);
  expectTruth(others, truth);
  return result;
}

double largestVariance(const BundleResult& result, std::size_t line) {
  return result.line_covariances[line].diagonal().maxCoeff();
}

TEST(OddLines, TwoViewsAreEnough) {
  Random random(11);
  for (int run = 0; run < 10; ++run) {
    const SpaceLine line{uniformVector(random, 1) + Eigen::Vector3d::UnitZ(),
                         Eigen::Vector3d(uniform(random, -0.3, 0.3), uniform(random, -0.3, 0.3), 1).normalized()};
    const OddLine odd = withOddLine(random, makeHouse(random, {}), line, {3, 5});
    BundleProblem problem;
    const BundleResult result = adjustBesideOddLine(random, odd, problem);
    EXPECT_LT(largestLineError(problem, odd.house.truth), 1e-4);
    EXPECT_LT(largestVariance(result, odd.line), 1e-3);
  }
}

TEST(OddLines, OneViewLeavesItsDepthUnknown) {
  Random random(12);
  const SpaceLine line{{0.2, -0.3, 1}, Eigen::Vector3d(1, 2, 2) / 3};
  const OddLine odd = withOddLine(random, makeHouse(random, {}), line, {3});
  BundleProblem problem;
  const BundleResult result = adjustBesideOddLine(random, odd, problem);
  EXPECT_GT(largestVariance(result, odd.line), 1e4);
}

// All planes through it and its cameras are the same one.
TEST(OddLines, AlongTheMotionItsDepthIsUnknown) {
  Random random(13);
  for (int run = 0; run < 10; ++run) {
    BundleScene house = makeHouse(random, {});
    const Eigen::Vector3d from = centreOf(house, 2), motion = (centreOf(house, 5) - from).normalized();
    const SpaceLine line{from + motion + lineBasis(motion) * Eigen::Vector2d(0.5, 0.7), motion};
    const OddLine odd = withOddLine(random, house, line, {2, 5});
    BundleProblem problem;
    const BundleResult result = adjustBesideOddLine(random, odd, problem);
    EXPECT_GT(largestVariance(result, odd.line), 1e2);
  }
}

TEST(OddLines, ThroughACameraTheyAreKnownByTheOthers) {
  Random random(14);
  for (int run = 0; run < 10; ++run) {
    const BundleScene house = makeHouse(random, {});
    const Eigen::Vector3d towards = Eigen::Vector3d(0.3, 0.2, 1.2) - centreOf(house, 4);
    const SpaceLine line{centreOf(house, 4) + 0.8 * towards, towards.normalized()};
    const OddLine odd = withOddLine(random, house, line, {0, 2, 4, 6});
    // Where it is seen end-on there are no errors.
    BundleProblem exact = odd.house.truth;
    const BundleResult at_truth = adjustBundle(odd.house.camera, exact, {0, 2});
    for (std::size_t k = odd.first_observation; k < at_truth.line_errors.size(); ++k) {
      const bool end_on = exact.line_observations[k].camera == 4;
      EXPECT_EQ(at_truth.line_errors[k] == infinite_value, end_on) << k;
      EXPECT_EQ(at_truth.line_errors[k] < 0.01, !end_on) << k;
    }
    BundleProblem problem;
    adjustBesideOddLine(random, odd, problem);
    EXPECT_LT(largestLineError(problem, odd.house.truth), 1e-4);
  }
}

TEST(OddLines, SeenEndOnAloneNothingIsKnownOfThem) {
  Random random(15);
  const BundleScene house = makeHouse(random, {});
  const Eigen::Vector3d towards = Eigen::Vector3d(0, 0, 1) - centreOf(house, 4);
  const SpaceLine line{centreOf(house, 4) + 0.8 * towards, towards.normalized()};
  OddLine odd = withOddLine(random, house, line, {4});
  for (BundleCamera& c : odd.house.truth.cameras) c.fixed = true;
  BundleProblem problem = odd.house.truth;
  const BundleResult result = adjustBundle(odd.house.camera, problem, manyIterations());
  ASSERT_TRUE(result.usable);
  EXPECT_LT(changeBetween(problem.lines[odd.line].line, line).norm(), 1e-12);
  EXPECT_TRUE(result.line_covariances[odd.line].isApprox(1e6 * Eigen::Matrix4d::Identity()));
  EXPECT_EQ(result.line_errors.back(), infinite_value);
}

TEST(UnusableLines, ValuesThatAreNoNumbersTakeNoPart) {
  Random random(16);
  const BundleScene house = makeHouse(random, {});
  BundleProblem problem = perturbedHouse(random, house.truth);
  problem.line_observations[0].bearing.x() = nan_value;
  problem.line_observations[1].bearing.setZero();
  problem.line_observations[2].sigma = nan_value;
  problem.line_observations[3].sigma = 0;
  problem.line_observations[4].sigma = -house_sigma;
  problem.line_observations[5].row = infinite_value;
  problem.lines[5].line.direction.y() = nan_value;
  problem.lines[6].line.point.z() = infinite_value;
  problem.lines[7].line.direction.setZero();
  const BundleResult result = adjustBundle(house.camera, problem, manyIterations());
  ASSERT_TRUE(result.usable);
  EXPECT_LT(largestTranslationError(problem, house.truth), 1e-5);
  for (std::size_t k = 0; k < problem.line_observations.size(); ++k) {
    const int line = problem.line_observations[k].line;
    if (k < 6 || (line >= 5 && line <= 7)) {
      EXPECT_EQ(result.line_errors[k], infinite_value) << k;
    } else {
      EXPECT_LT(result.line_errors[k], 0.01) << k;
    }
  }
  for (std::size_t i = 0; i < problem.lines.size(); ++i) {
    const bool unusable = i >= 5 && i <= 7;
    EXPECT_EQ(result.line_covariances[i].isZero(0), unusable) << i;
    if (!unusable) {
      EXPECT_LT(changeBetween(problem.lines[i].line, house.truth.lines[i].line).norm(), 1e-5) << i;
    }
  }
}

TEST(UnusableLines, IndicesOutOfRangeLeaveTheProblem) {
  Random random(17);
  const BundleScene house = makeHouse(random, {});
  const BundleProblem good = perturbedHouse(random, house.truth);
  for (const int bad : {-1, 12, 1000000}) {
    for (const bool is_camera : {false, true}) {
      BundleProblem problem = good;
      (is_camera ? problem.line_observations[3].camera : problem.line_observations[3].line) = bad;
      const BundleResult result = adjustBundle(house.camera, problem, {});
      EXPECT_FALSE(result.usable);
      EXPECT_TRUE(sameBytes(problem, good) && sameLines(problem, good));
      EXPECT_EQ(result.line_errors, std::vector<double>(problem.line_observations.size(), infinite_value));
      EXPECT_EQ(result.line_covariances.size(), problem.lines.size());
    }
  }
}

TEST(UnusableLines, ScaleThatCannotBeKeptLeavesThem) {
  Random random(19);
  const BundleScene house = makeHouse(random, {});
  BundleProblem problem = perturbedHouse(random, house.truth);
  problem.cameras[1].fixed = false;
  problem.scale_camera = 4;
  problem.cameras[4].world_T_camera.translation = problem.cameras[0].world_T_camera.translation;
  const BundleProblem before = problem;
  EXPECT_FALSE(adjustBundle(house.camera, problem, {}).usable);
  EXPECT_TRUE(sameBytes(problem, before) && sameLines(problem, before));
}

TEST(UnusableLines, InterruptedLeavesThem) {
  Random random(18);
  const BundleScene house = makeHouse(random, {});
  BundleProblem problem = perturbedHouse(random, house.truth);
  const BundleProblem before = problem;
  const std::atomic<bool> interrupted{true};
  EXPECT_FALSE(adjustBundle(house.camera, problem, {}, &interrupted).usable);
  EXPECT_TRUE(sameBytes(problem, before) && sameLines(problem, before));
}

}  // namespace
}  // namespace edgeslam::test
