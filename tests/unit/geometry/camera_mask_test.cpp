#include "geometry/camera_mask.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace edgeslam {
namespace {

Camera camera() { return {CameraModel::pinhole_radial_tangential, 64, 48, 50, 50, 32, 24, {}}; }

// Black in the ten rows on top.
cv::Mat plateOnTop() {
  cv::Mat image(48, 64, CV_8U, cv::Scalar(255));
  image.rowRange(0, 10).setTo(0);
  return image;
}

TEST(CameraMask, BlackIsMaskedAndWhatIsNearItHidden) {
  const auto mask = makeCameraMask(plateOnTop());
  EXPECT_EQ(cv::countNonZero(mask->masked), 10 * 64);
  EXPECT_EQ(cv::countNonZero(mask->hidden), (10 + mask_margin) * 64);
  EXPECT_DOUBLE_EQ(maskedShare(*mask), 10.0 / 48);
  EXPECT_TRUE(isHidden(mask.get(), {30, 9 + mask_margin}));
  EXPECT_FALSE(isHidden(mask.get(), {30, 10 + mask_margin}));
}

TEST(CameraMask, GreyIsTakenForTheNearerOfBlackAndWhite) {
  cv::Mat image(1, 256, CV_8U);
  for (int x = 0; x < 256; ++x) image.at<unsigned char>(0, x) = static_cast<unsigned char>(x);
  EXPECT_EQ(cv::countNonZero(makeCameraMask(image)->masked), 128);
}

TEST(CameraMask, WithoutOneOnlyTheBorderCounts) {
  Camera looking = camera();
  EXPECT_FALSE(isHidden(nullptr, {30, 2}));
  EXPECT_TRUE(isLookedAt(looking, {30, 2}, 1));
  EXPECT_FALSE(isLookedAt(looking, {30, 2}, 3));
  looking.mask = makeCameraMask(plateOnTop());
  EXPECT_FALSE(isLookedAt(looking, {30, 2}, 1));
  EXPECT_TRUE(isLookedAt(looking, {30, 40}, 1));
  EXPECT_FALSE(isLookedAt(looking, {-1, 40}, 0));
}

TEST(CameraMask, LeavesNothingWhereTheMarginsMeet) {
  cv::Mat image(48, 64, CV_8U, cv::Scalar(0));
  EXPECT_FALSE(leavesSomething(*makeCameraMask(image)));
  image(cv::Rect(20, 20, 2 * mask_margin, 2 * mask_margin)).setTo(255);
  EXPECT_FALSE(leavesSomething(*makeCameraMask(image)));
  image(cv::Rect(20, 20, 2 * mask_margin + 1, 2 * mask_margin + 1)).setTo(255);
  EXPECT_TRUE(leavesSomething(*makeCameraMask(image)));
}

// Maps that were made with another mask are good.
TEST(CameraMask, IsNoneOfTheCalibration) {
  Camera masked = camera();
  masked.mask = makeCameraMask(plateOnTop());
  EXPECT_TRUE(masked == camera());
}

}  // namespace
}  // namespace edgeslam
