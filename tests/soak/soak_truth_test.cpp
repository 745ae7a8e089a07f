#include "soak/soak_truth.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/similarity.h"

namespace edgeslam {
namespace {

constexpr double sigma = 0.002;  // [map units]

// A walk of 6 m, with errors as the covariance says, in a map of another scale and frame.
std::vector<JudgedPose> honestWalk(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, sigma);
  const Similarity world_S_truth{0.4, rotationExp({0.3, -1, 0.2}), {5, -2, 1}};
  std::vector<JudgedPose> poses;
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.01 * i;
    JudgedPose pose;
    pose.truth = {3 * std::sin(t), 0.5 * std::cos(3 * t), 2 * std::cos(0.7 * t)};
    const Eigen::Vector3d error(noise(random), noise(random), noise(random));
    pose.world_T_camera = {rotationExp({0.1 * t, 0.2, -0.05 * t}), world_S_truth * pose.truth + error};
    pose.world_covariance = sigma * sigma * Matrix6d::Identity();
    poses.push_back(pose);
  }
  return poses;
}

TEST(SoakTruth, AnHonestWalkIsJudgedAsWhatItIs) {
  const SoakTruth truth = judgeByTruth(honestWalk(1));
  EXPECT_EQ(truth.poses, 1000U);
  EXPECT_NEAR(truth.error_m, std::sqrt(3.0) * sigma / 0.4, 0.1 * sigma);
  EXPECT_NEAR(truth.beyond_share, 0.01, 0.01);
  EXPECT_EQ(truth.wrong_share, 0);
}

TEST(SoakTruth, ACovarianceThatIsTooSmallIsSeen) {
  std::vector<JudgedPose> poses = honestWalk(2);
  for (JudgedPose& pose : poses) pose.world_covariance /= 9;
  EXPECT_GT(judgeByTruth(poses).beyond_share, 0.5);
}

// Of two axes only one is known: an error along the other is none to be surprised by.
TEST(SoakTruth, TheCovarianceIsThatOfTheCamerasAxes) {
  std::vector<JudgedPose> poses = honestWalk(3);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    JudgedPose& pose = poses[i];
    pose.world_T_camera.translation += pose.world_T_camera.rotation * Eigen::Vector3d(0, i % 2 == 0 ? 0.02 : -0.02, 0);
    pose.world_covariance(1, 1) = 0.02 * 0.02;
  }
  EXPECT_LT(judgeByTruth(poses).beyond_share, 0.02);
}

TEST(SoakTruth, AFewWrongPosesDoNotHide) {
  std::vector<JudgedPose> poses = honestWalk(4);
  for (std::size_t i = 400; i < 430; ++i) poses[i].world_T_camera.translation.x() += 1;
  EXPECT_NEAR(judgeByTruth(poses).wrong_share, 0.03, 1e-9);
  // A pose that says that it may be there is not called good wrongly.
  for (std::size_t i = 400; i < 430; ++i) poses[i].world_covariance *= 1e6;
  EXPECT_EQ(judgeByTruth(poses).wrong_share, 0);
}

TEST(SoakTruth, OtherWorldsHaveFramesOfTheirOwn) {
  std::vector<JudgedPose> poses = honestWalk(5);
  for (std::size_t i = 700; i < 1000; ++i) {
    poses[i].world = 1;
    poses[i].world_T_camera.translation *= 7;
  }
  const SoakTruth truth = judgeByTruth(poses);
  EXPECT_EQ(truth.poses, 700U);
  EXPECT_EQ(truth.wrong_share, 0);
}

std::vector<SoakTruth> passes() {
  std::vector<SoakTruth> passes;
  for (int pass = 0; pass < 12; ++pass) {
    for (const char* sequence : {"hall", "room"}) passes.push_back({pass, sequence, 900, 0.02 + 0.005 * (pass % 3)});
  }
  return passes;
}

TEST(SoakTruth, ErrorsThatStayAreNoProblem) { EXPECT_TRUE(truthProblems(passes()).empty()); }

TEST(SoakTruth, AnErrorThatGrowsIsSeenInItsSequence) {
  std::vector<SoakTruth> growing = passes();
  for (SoakTruth& pass : growing) {
    if (pass.sequence == "hall") pass.error_m += 0.01 * static_cast<double>(pass.pass);
  }
  const std::vector<std::string> problems = truthProblems(growing);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].rfind("hall: error", 0), 0U) << problems[0];
}

TEST(SoakTruth, WrongPosesThatAreCalledGoodAreSeen) {
  std::vector<SoakTruth> wrong = passes();
  wrong[5].wrong_share = 0.02;
  const std::vector<std::string> problems = truthProblems(wrong);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0], "room: 2.0 % of the poses of pass 2 are wrong and called good");
}

}  // namespace
}  // namespace edgeslam
