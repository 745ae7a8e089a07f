// Doubt begins where the map does not bear out a pose, lasts until it does, and widens what is said of the position.
#include "tracking/map_confirmation.h"

#include <gtest/gtest.h>

namespace edgeslam {
namespace {

constexpr PointsConfirmed borne_out{200, 160}, contradicted{200, 10}, hardly_borne_out{200, 40}, few_points{40, 0};

ConfirmedPose confirmedAt(double x, KeyframeId keyframe) {
  return {{Eigen::Quaterniond::Identity(), {x, 0, 0}}, 1'000'000 * keyframe, keyframe};
}

TEST(MapConfirmation, NothingIsInDoubtWhereTheMapBearsPosesOut) {
  MapConfirmation confirmation{MapConfirmationOptions()};
  EXPECT_FALSE(confirmation.lastBeforeDoubt());
  confirmation.observe(borne_out, confirmedAt(1, 3));
  EXPECT_FALSE(confirmation.lastBeforeDoubt());
  EXPECT_EQ(confirmation.positionVariance(confirmedAt(5, 3).world_T_camera), 0);
  EXPECT_EQ(confirmation.points().confirmed, borne_out.confirmed);
}

TEST(MapConfirmation, DoubtBeginsAtTheLastPoseThatWasBorneOutAndEndsAtTheNext) {
  MapConfirmation confirmation{MapConfirmationOptions()};
  confirmation.observe(borne_out, confirmedAt(1, 3));
  confirmation.observe(contradicted, confirmedAt(2, 4));
  confirmation.observe(contradicted, confirmedAt(4, 6));
  ASSERT_TRUE(confirmation.lastBeforeDoubt());
  EXPECT_EQ(confirmation.lastBeforeDoubt()->keyframe, 3);
  EXPECT_EQ(confirmation.lastBeforeDoubt()->world_T_camera.translation.x(), 1);
  EXPECT_DOUBLE_EQ(confirmation.positionVariance(confirmedAt(4, 6).world_T_camera), 9);
  confirmation.observe(borne_out, confirmedAt(5, 7));
  EXPECT_FALSE(confirmation.lastBeforeDoubt());
  EXPECT_EQ(confirmation.positionVariance(confirmedAt(6, 7).world_T_camera), 0);
}

TEST(MapConfirmation, OfFewPointsTheShareSaysNothing) {
  MapConfirmation confirmation{MapConfirmationOptions()};
  confirmation.observe(borne_out, confirmedAt(1, 3));
  confirmation.observe(few_points, confirmedAt(2, 4));
  EXPECT_FALSE(confirmation.lastBeforeDoubt());
  confirmation.observe(contradicted, confirmedAt(3, 5));
  ASSERT_TRUE(confirmation.lastBeforeDoubt());
  EXPECT_EQ(confirmation.lastBeforeDoubt()->keyframe, 4);
}

TEST(MapConfirmation, AFewPointsByChanceBeginNoDoubtAndEndNone) {
  MapConfirmation confirmation{MapConfirmationOptions()};
  confirmation.observe(borne_out, confirmedAt(1, 3));
  confirmation.observe(hardly_borne_out, confirmedAt(2, 4));
  EXPECT_FALSE(confirmation.lastBeforeDoubt());
  confirmation.observe(contradicted, confirmedAt(3, 5));
  confirmation.observe(hardly_borne_out, confirmedAt(4, 6));
  confirmation.observe(few_points, confirmedAt(5, 7));
  ASSERT_TRUE(confirmation.lastBeforeDoubt());
  EXPECT_EQ(confirmation.lastBeforeDoubt()->keyframe, 4);
  confirmation.observe(borne_out, confirmedAt(6, 8));
  EXPECT_FALSE(confirmation.lastBeforeDoubt());
}

TEST(MapConfirmation, ACameraThatWasFoundAgainIsBelievedOnceMuchOfTheMapIsSeen) {
  MapConfirmation confirmation{MapConfirmationOptions()};
  confirmation.observe(borne_out, confirmedAt(1, 3));
  confirmation.askForProof();
  confirmation.observe(hardly_borne_out, confirmedAt(2, 4));
  ASSERT_TRUE(confirmation.lastBeforeDoubt());
  EXPECT_EQ(confirmation.lastBeforeDoubt()->keyframe, 3);
  confirmation.observe(borne_out, confirmedAt(3, 5));
  confirmation.observe(hardly_borne_out, confirmedAt(4, 6));
  EXPECT_FALSE(confirmation.lastBeforeDoubt());
}

TEST(MapConfirmation, ACameraThatWasFoundAgainWhereLittleIsMappedIsNotInDoubt) {
  MapConfirmation confirmation{MapConfirmationOptions()};
  confirmation.observe(borne_out, confirmedAt(1, 3));
  confirmation.askForProof();
  confirmation.observe(few_points, confirmedAt(2, 4));
  EXPECT_FALSE(confirmation.lastBeforeDoubt());
}

TEST(MapConfirmation, WithNoPoseBorneOutBeforeThereIsNothingToGoBackTo) {
  MapConfirmation confirmation{MapConfirmationOptions()};
  confirmation.observe(contradicted, confirmedAt(2, 4));
  EXPECT_FALSE(confirmation.lastBeforeDoubt());
}

TEST(MapConfirmation, MovesWithTheMapAndIsForgotten) {
  MapConfirmation confirmation{MapConfirmationOptions()};
  confirmation.observe(borne_out, confirmedAt(1, 3));
  confirmation.observe(contradicted, confirmedAt(2, 4));
  confirmation.move({2, Eigen::Quaterniond::Identity(), {0, 0, 1}});
  ASSERT_TRUE(confirmation.lastBeforeDoubt());
  EXPECT_TRUE(confirmation.lastBeforeDoubt()->world_T_camera.translation.isApprox(Eigen::Vector3d(2, 0, 1)));
  confirmation.forget();
  EXPECT_FALSE(confirmation.lastBeforeDoubt());
  confirmation.observe(contradicted, confirmedAt(2, 4));
  EXPECT_FALSE(confirmation.lastBeforeDoubt());
}

}  // namespace
}  // namespace edgeslam
