// P22: thumbnails tell how a camera turned between two images.
#include "places/thumbnail.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "unit/geometry/degree.h"
#include "unit/places/made_place.h"

namespace edgeslam::test {
namespace {

Thumbnail thumbnailAt(const Pose& pose, std::uint64_t room = 7) {
  return makeThumbnail(buildPyramid(renderRoom(room, placeCamera(), pose), 4));
}

TEST(Thumbnail, HasTheImagesProportionsAndNoMeanToSpeakOf) {
  const Thumbnail thumbnail = thumbnailAt(Pose());
  EXPECT_EQ(thumbnail.cols, thumbnail_width);
  EXPECT_EQ(thumbnail.rows, 30);
  EXPECT_LT(std::abs(cv::mean(thumbnail)[0]), 5);
}

TEST(Thumbnail, IsItsOwnBestMatch) {
  const Thumbnail thumbnail = thumbnailAt(Pose());
  const ThumbnailMatch match = matchTurned(thumbnail, thumbnail);
  EXPECT_NEAR(match.correlation, 1, 1e-4);
  EXPECT_EQ(match.roll, 0);
  EXPECT_LT(match.shift.norm(), 0.3);
}

TEST(Thumbnail, LightDoesNotMatter) {
  const cv::Mat grey = renderRoom(7, placeCamera(), Pose());
  cv::Mat darker;
  grey.convertTo(darker, CV_8U, 0.5, 20);
  const Thumbnail thumbnail = makeThumbnail(buildPyramid(grey, 4));
  EXPECT_GT(matchShifted(thumbnail, makeThumbnail(buildPyramid(darker, 4))).correlation, 0.98);
}

TEST(Thumbnail, OtherRoomsAreLessAlike) {
  const Thumbnail here = thumbnailAt(Pose());
  const double same = matchTurned(here, thumbnailAt({rotationExp({0, 0.08, 0}), {0.05, 0, 0}})).correlation;
  for (const std::uint64_t other : {8U, 9U, 10U}) {
    EXPECT_LT(matchTurned(here, thumbnailAt(Pose(), other)).correlation, same - 0.1);
  }
}

class ThumbnailTurn : public testing::TestWithParam<Eigen::Vector3d> {};

TEST_P(ThumbnailTurn, TellsHowTheCameraTurned) {
  const Eigen::Quaterniond turn = rotationExp(GetParam() * degree);
  const ThumbnailMatch match = matchTurned(thumbnailAt(Pose()), thumbnailAt({turn, Eigen::Vector3d::Zero()}));
  EXPECT_LT(rotationAngle(rotationOf(placeCamera(), match), turn) / degree, 3.5);
}

INSTANTIATE_TEST_SUITE_P(Turns, ThumbnailTurn,
                         testing::Values(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 8, 0), Eigen::Vector3d(0, -8, 0),
                                         Eigen::Vector3d(6, 0, 0), Eigen::Vector3d(-6, 0, 0), Eigen::Vector3d(0, 0, 12),
                                         Eigen::Vector3d(0, 0, -18), Eigen::Vector3d(3, 5, -6)));

// Of two rooms seen past the same plate.
TEST(Thumbnail, WhatIsMaskedDoesNotCount) {
  const auto at = [](std::uint64_t room, int plate, const CameraMask* mask) {
    cv::Mat grey = renderRoom(room, placeCamera(), Pose());
    grey.rowRange(0, grey.rows / 3).setTo(plate);
    grey(cv::Rect(grey.cols / 3, 0, grey.cols / 3, grey.rows / 4)).setTo(255 - plate);
    return makeThumbnail(buildPyramid(grey, 4), mask);
  };
  cv::Mat image(placeCamera().height, placeCamera().width, CV_8U, cv::Scalar(255));
  image.rowRange(0, image.rows / 3).setTo(0);
  const auto mask = makeCameraMask(image);
  EXPECT_EQ(cv::norm(at(7, 10, mask.get()), at(7, 200, mask.get()), cv::NORM_INF), 0);
  const auto alike = [&](const CameraMask* m) { return matchShifted(at(7, 10, m), at(8, 10, m)).correlation; };
  EXPECT_LT(alike(mask.get()), alike(nullptr) - 0.1);
}

}  // namespace
}  // namespace edgeslam::test
