#include "mapping/camera_trial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "unit/mapping/line_scene.h"
#include "unit/mapping/wrong_lens.h"

namespace edgeslam {
namespace {

using test::Walk;

TEST(CameraTrial, TheRightCameraCostsLeast) {
  const Camera right = Walk::camera(), wrong = test::withFocalLengths(right, 1.05);
  const LookedAt at = test::lookedAt(wrong, test::mappedWith(wrong, 2));
  EXPECT_LT(costWith(at, right), 0.9 * costWith(at, wrong));
  EXPECT_LT(costWith(at, right), costWith(at, test::withFocalLengths(right, 0.95)));
  EXPECT_NEAR(costWith(at, wrong), at.cost, 1e-3 * at.cost);
}

// A line that the first adjustment dissolves costs something in no trial. It is not to look as if trials cost less.
TEST(CameraTrial, TheCameraThatThereIsCostsWhatTrialsAreHeldAgainst) {
  test::Random random(4);
  Map map = test::mapOfPanels({}, random);
  test::contradictViewsOf(6, map);
  const auto at = lookAt(test::distorted_camera, {}, {}, {0, 1, 2, 3, 4}, map);
  ASSERT_TRUE(at);
  ASSERT_EQ(at->map.lines.count(6), 0U);
  EXPECT_NEAR(costWith(*at, test::distorted_camera), at->cost, 1e-2 * at->cost);
}

TEST(CameraTrial, ACameraThatFoldsTheImageIsNoneUnlessTheOneThatThereWasDoesToo) {
  const Camera right = Walk::camera(), folds = test::withDistortion(right, -1);
  EXPECT_TRUE(std::isinf(costWith(test::lookedAt(right, test::mappedWith(right, 2)), folds)));
  LookedAt folded = test::lookedAt(right, test::mappedWith(right, 2));
  folded.camera = folds;
  EXPECT_TRUE(std::isfinite(costWith(folded, right)));
}

TEST(CameraTrial, WhatOthersSayIsLeftOut) {
  const Walk walk = test::mappedWith(Walk::camera(), 3);
  const std::vector<KeyframeId> some{4, 5, 6, 7, 8, 9, 10};
  const std::set<KeyframeId> themselves(some.begin(), some.end());
  const Map left = seenBy(some, walk.map);
  EXPECT_GT(left.points.size(), 0u);
  EXPECT_LT(left.points.size(), walk.map.points.size());
  for (const auto& [id, point] : left.points) EXPECT_EQ(themselves.count(point.host), 1u) << id;
}

}  // namespace
}  // namespace edgeslam
