#include "places/world_alignment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace edgeslam {
namespace {

const Similarity true_alignment{2.5, rotationExp({0.3, -1.2, 0.5}), {4, -2, 7}};

// Along a curve, with errors of so much of the scene's distance (which is 5), and wrong ones among them.
std::vector<FoundInBoth> cameras(int right, int wrong, double error = 0, double length = 4) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<FoundInBoth> found;
  for (int i = 0; i < right + wrong; ++i) {
    const double along = length * i / (right + wrong);
    const Pose from{rotationExp({0, 0.2 * along, 0}), {along, 0.3 * std::sin(along), 0.1 * along}};
    FoundInBoth camera{from, moved(true_alignment, from), 5};
    const Eigen::Vector3d off(any(random), any(random), any(random));
    if (i < right) {
      camera.to_T_camera.translation += 5 * error * off;
    } else {
      camera.to_T_camera = {rotationExp(3 * off), 20 * off};
    }
    found.push_back(camera);
  }
  return found;
}

void expectTruth(const Similarity& found, double error) {
  EXPECT_NEAR(found.scale, true_alignment.scale, error * true_alignment.scale);
  EXPECT_LT(rotationAngle(found.rotation, true_alignment.rotation), error);
  EXPECT_LT((found.translation - true_alignment.translation).norm(), 10 * error);
}

TEST(AlignWorlds, FindsTheSimilarityThatMostCamerasSay) {
  std::size_t agreeing = 0;
  const auto exact = alignWorlds(cameras(3, 0), {}, agreeing);
  ASSERT_TRUE(exact);
  EXPECT_EQ(agreeing, 3U);
  expectTruth(exact->to_S_from, 1e-9);
  const auto rough = alignWorlds(cameras(20, 8, 0.02), {}, agreeing);
  ASSERT_TRUE(rough);
  expectTruth(rough->to_S_from, 0.05);
  EXPECT_EQ(rough->agreeing.size(), 20U);
  for (const std::size_t place : rough->agreeing) EXPECT_LT(place, 20U);
}

TEST(AlignWorlds, TooFewThatAgreeAreRefused) {
  std::size_t agreeing = 9;
  EXPECT_FALSE(alignWorlds({}, {}, agreeing));
  EXPECT_EQ(agreeing, 0U);
  EXPECT_FALSE(alignWorlds(cameras(2, 0), {}, agreeing));
  EXPECT_EQ(agreeing, 2U);
  EXPECT_FALSE(alignWorlds(cameras(5, 6), {}, agreeing)) << "not half of them";
  EXPECT_EQ(agreeing, 5U);
}

// From one spot the scale is not told.
TEST(AlignWorlds, CamerasThatStandTogetherAreRefused) {
  std::size_t agreeing = 0;
  EXPECT_FALSE(alignWorlds(cameras(10, 0, 0, 0.05), {}, agreeing));
  EXPECT_FALSE(alignWorlds(cameras(10, 0, 0, 0), {}, agreeing));
}

// Along a line the centres leave a turn about it open, which the cameras' own directions tell.
TEST(AlignWorlds, AStraightWayIsEnough) {
  std::vector<FoundInBoth> found;
  for (int i = 0; i < 6; ++i) {
    const Pose from{rotationExp({0.1, 0.2, 0}), {0.6 * i, 0, 0}};
    found.push_back({from, moved(true_alignment, from), 5});
  }
  std::size_t agreeing = 0;
  const auto alignment = alignWorlds(found, {}, agreeing);
  ASSERT_TRUE(alignment);
  expectTruth(alignment->to_S_from, 1e-9);
}

}  // namespace
}  // namespace edgeslam
