#include "evaluation/evaluation.h"

#include <cmath>

#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

constexpr double pi = 3.14159265358979323846;

StampedPose at(double seconds, const Eigen::Vector3d& position, const Eigen::Vector3d& rotation = {0, 0, 0}) {
  return {std::llround(1e9 * seconds), {rotationExp(rotation), position}};
}

// A winding path, ten poses a second.
Trajectory winding(int count = 60) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    const double t = 0.1 * i;
    trajectory.push_back(at(100 + t, {std::cos(t), 2 * std::sin(0.7 * t), 0.3 * t}, {0.1 * t, 0.2 * std::sin(t), 0}));
  }
  return trajectory;
}

// The same path as seen in another frame and scale.
Trajectory moved(const Trajectory& trajectory, const Similarity& similarity) {
  Trajectory result = trajectory;
  for (StampedPose& stamped : result) {
    stamped.world_T_camera.translation = similarity * stamped.world_T_camera.translation;
    stamped.world_T_camera.rotation = similarity.rotation * stamped.world_T_camera.rotation;
  }
  return result;
}

const Similarity motion{2.5, rotationExp({0.3, -1.2, 0.4}), {3, -1, 7}};

TEST(AbsoluteError, VanishesForTheSamePathInAnotherFrameAndScale) {
  const AbsoluteError error = absoluteError(moved(winding(), motion), winding(), Alignment::similarity);
  EXPECT_EQ(error.pairs, 60);
  EXPECT_LT(error.translation.max, 1e-12);
  EXPECT_NEAR(error.reference_T_estimate.scale, 1 / 2.5, 1e-12);
  EXPECT_EQ(error.times_ns.size(), 60U);
  EXPECT_EQ(error.errors.size(), 60U);
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_LT((error.aligned[i] - winding()[i].world_T_camera.translation).norm(), 1e-12);
  }
}

TEST(AbsoluteError, RigidAlignmentKeepsTheScale) {
  const Similarity rigid{1, motion.rotation, motion.translation};
  EXPECT_LT(absoluteError(moved(winding(), rigid), winding(), Alignment::rigid).translation.max, 1e-12);
  const AbsoluteError scaled = absoluteError(moved(winding(), motion), winding(), Alignment::rigid);
  EXPECT_EQ(scaled.reference_T_estimate.scale, 1);
  EXPECT_GT(scaled.translation.rmse, 0.5);
}

TEST(AbsoluteError, GivesTheFiguresOfAHandMadeCase) {
  const Trajectory reference{at(1, {0, 0, 0}), at(2, {1, 0, 0}), at(3, {2, 0, 0}), at(4, {3, 0, 0})};
  const Trajectory estimate{at(1, {0, 1, 0}), at(2, {1, 0, 2}), at(3, {2, 3, 0}), at(4, {3, 0, 10})};
  const AbsoluteError error = absoluteError(estimate, reference, Alignment::none);
  EXPECT_EQ(error.errors, (std::vector<double>{1, 2, 3, 10}));
  EXPECT_DOUBLE_EQ(error.translation.rmse, std::sqrt((1 + 4 + 9 + 100) / 4.0));
  EXPECT_DOUBLE_EQ(error.translation.mean, 4);
  EXPECT_DOUBLE_EQ(error.translation.median, 2.5);
  EXPECT_DOUBLE_EQ(error.translation.standard_deviation, std::sqrt((9 + 4 + 1 + 36) / 4.0));
  EXPECT_DOUBLE_EQ(error.translation.min, 1);
  EXPECT_DOUBLE_EQ(error.translation.max, 10);
}

TEST(AbsoluteError, AssociatesNearestFirstAndEachPoseOnce) {
  const Trajectory reference{at(1.000, {0, 0, 0}), at(1.030, {5, 0, 0})};
  // Both are nearest to the first reference pose; the nearer one gets it, the other gets the next within the tolerance.
  const Trajectory estimate{at(1.004, {0, 0, 0}), at(1.012, {5, 0, 0})};
  const AbsoluteError error = absoluteError(estimate, reference, Alignment::none, 0.02);
  EXPECT_EQ(error.pairs, 2);
  EXPECT_EQ(error.translation.max, 0);
  EXPECT_EQ(absoluteError(estimate, reference, Alignment::none, 0.01).pairs, 1);
}

TEST(AbsoluteError, TheToleranceItselfIsWithinIt) {
  const Trajectory reference{at(1, {0, 0, 0})};
  EXPECT_EQ(absoluteError({at(1.02, {1, 0, 0})}, reference, Alignment::none, 0.02).pairs, 1);
  expectInputError([&] { absoluteError({at(1.020000001, {1, 0, 0})}, reference, Alignment::none, 0.02); }, "0 of 1");
}

TEST(AbsoluteError, TooFewPairsAreTold) {
  const Trajectory two = winding(2);
  expectInputError([&] { absoluteError(two, winding(), Alignment::similarity); }, "only 2 of 2", "at least 3");
  EXPECT_EQ(absoluteError(two, winding(), Alignment::none).pairs, 2);
  expectInputError([&] { absoluteError({}, winding(), Alignment::none); }, "only 0 of 0");
  expectInputError([&] { absoluteError(winding(), {}, Alignment::none); }, "only 0 of 60");
  expectInputError([&] { absoluteError(winding(), winding(), Alignment::rigid, NAN); }, "tolerance");
  expectInputError([&] { absoluteError(winding(), winding(), Alignment::rigid, -1); }, "tolerance");
}

TEST(AbsoluteError, AVastToleranceStillEnds) {
  const AbsoluteError error = absoluteError(winding(800), winding(800), Alignment::none, 1e9);
  EXPECT_EQ(error.pairs, 800);
  EXPECT_EQ(error.translation.max, 0);
}

TEST(AbsoluteError, APathThatStandsStillHasFiniteFigures) {
  Trajectory still = winding();
  for (StampedPose& stamped : still) stamped.world_T_camera.translation.setZero();
  EXPECT_TRUE(std::isfinite(absoluteError(still, winding(), Alignment::similarity).translation.rmse));
}

TEST(RelativeError, VanishesForTheSamePathInAnotherFrameAndScale) {
  const RelativeError error = relativeError(moved(winding(), motion), winding(), Alignment::similarity);
  EXPECT_EQ(error.pairs, 49) << "60 poses, of which 10 have no pose a second later and one only the last";
  EXPECT_LT(error.translation.max, 1e-12);
  EXPECT_LT(error.rotation.max, 1e-7);
}

TEST(RelativeError, MeasuresTheDriftOfASecond) {
  Trajectory reference, estimate;
  for (int i = 0; i < 30; ++i) {
    const double t = 0.1 * i;
    reference.push_back(at(t, {t, 0, 0}));
    estimate.push_back(at(t, {1.05 * t, 0, 0}));
  }
  const RelativeError error = relativeError(estimate, reference, Alignment::none, 2.0);
  EXPECT_NEAR(error.translation.rmse, 0.1, 1e-12);
  EXPECT_NEAR(error.translation.standard_deviation, 0, 1e-9);
  EXPECT_NEAR(relativeError(estimate, reference, Alignment::similarity, 2.0).translation.rmse, 0, 1e-9);
}

TEST(RelativeError, MeasuresTheRotationOfASecond) {
  Trajectory reference, estimate;
  for (int i = 0; i < 30; ++i) {
    const double t = 0.1 * i;
    reference.push_back(at(t, {std::cos(t), std::sin(t), 0}));
    estimate.push_back(at(t, {std::cos(t), std::sin(t), 0}, {0, 0, 0.02 * t}));
  }
  const RelativeError error = relativeError(estimate, reference, Alignment::none, 1.0);
  EXPECT_EQ(error.pairs, 19);
  EXPECT_NEAR(error.rotation.mean, 0.02, 1e-9);
  EXPECT_NEAR(error.rotation.max, 0.02, 1e-9);
}

TEST(RelativeError, ComparesMotionsBackwardsAsTheTumTool) {
  // A true motion of 1 along x without rotation, estimated with a quarter turn at the first pose: from the second pose
  // the first lies at (-1, 0, 0) in both; seen forwards it would be off by sqrt(2).
  const Trajectory reference{at(0, {0, 0, 0}), at(1, {1, 0, 0}), at(2, {2, 0, 0})};
  const Trajectory estimate{at(0, {0, 0, 0}, {0, 0, pi / 2}), at(1, {1, 0, 0}), at(2, {2, 0, 0})};
  const RelativeError error = relativeError(estimate, reference, Alignment::none, 1.0);
  EXPECT_EQ(error.pairs, 1);
  EXPECT_NEAR(error.translation.max, 0, 1e-12);
  EXPECT_NEAR(error.rotation.max, pi / 2, 1e-12);
}

TEST(RelativeError, NoPoseIsPairedWithItself) {
  const Trajectory sparse{at(0, {0, 0, 0}), at(10, {1, 0, 0}), at(20, {2, 1, 0}), at(30, {3, 0, 1})};
  EXPECT_EQ(relativeError(sparse, sparse, Alignment::none, 1.0).pairs, 0);
  EXPECT_EQ(relativeError(sparse, sparse, Alignment::none, 10.0).pairs, 2);
  expectInputError([&] { relativeError(sparse, sparse, Alignment::none, 0); }, "interval");
  expectInputError([&] { relativeError(sparse, sparse, Alignment::none, NAN); }, "interval");
}

TEST(Coverage, CountsGapsAndTheStart) {
  Trajectory estimate = winding(60);
  const Coverage whole = coverage(estimate, winding(60));
  EXPECT_DOUBLE_EQ(whole.time_share, 1);
  EXPECT_DOUBLE_EQ(whole.pose_share, 1);
  EXPECT_DOUBLE_EQ(whole.start_s, 0);
  estimate.erase(estimate.begin() + 30, estimate.begin() + 40);  // a second without poses
  estimate.erase(estimate.begin(), estimate.begin() + 10);       // and none in the first
  const Coverage part = coverage(estimate, winding(60));
  EXPECT_NEAR(part.time_share, (5.9 - 1.0 - 1.1) / 5.9, 1e-9);
  EXPECT_NEAR(part.pose_share, 40.0 / 60, 1e-12);
  EXPECT_NEAR(part.pose_share_after_start, 40.0 / 50, 1e-12);
  EXPECT_NEAR(part.start_s, 1, 1e-9);
  expectInputError([&] { coverage({}, winding()); }, "without poses");
}

struct PublishedCase {
  const char* estimate;
  const char* reference;
  double rmse_m;
  int pairs;
};

// The test's name has it.
void PrintTo(const PublishedCase& published, std::ostream* stream) { *stream << published.estimate; }

class PublishedTrajectories : public testing::TestWithParam<PublishedCase> {};

TEST_P(PublishedTrajectories, GiveThePublishedFigures) {
  const std::string folder = std::string(EDGESLAM_SOURCE_DIR) + "/../shared/trajectories/evo/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no published trajectories in " << folder;
  const AbsoluteError error = absoluteError(readTrajectory(folder + GetParam().estimate),
                                            readTrajectory(folder + GetParam().reference), Alignment::similarity, 0.02);
  EXPECT_EQ(error.pairs, GetParam().pairs);
  EXPECT_NEAR(error.translation.rmse, GetParam().rmse_m, 0.5e-5);
}

INSTANTIATE_TEST_SUITE_P(
    Evaluation, PublishedTrajectories,
    testing::Values(PublishedCase{"fr2_desk_ORB_kf_mono.txt", "fr2_desk_groundtruth.txt", 0.00790, 122},
                    PublishedCase{"freiburg1_xyz-ORB_kf_mono.txt", "freiburg1_xyz-groundtruth.txt", 0.00975, 32}));

}  // namespace
}  // namespace edgeslam
