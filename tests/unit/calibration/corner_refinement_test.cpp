#include "calibration/corner_refinement.h"

#include <gtest/gtest.h>

#include "unit/calibration/rendered_board.h"

namespace edgeslam {
namespace {

Camera refinementCamera() {
  return {CameraModel::pinhole_radial_tangential, 480, 360, 270.2, 269.1, 236.1, 183.4,
          {-0.27, 0.07, 0.0006, -0.0009, 0}};
}

TEST(CornerRefinement, FindsCornersToHundredthsOfAPixel) {
  for (const char* text : {"chessboard:9x6:30mm", "charuco:8x6:30mm:22mm", "aprilgrid:5x4:30mm:0.3"}) {
    const Board board = parseBoard(text);
    const Hold hold{0.42, 0.55, 0.75, 0.35, -0.2, 0.3};
    const cv::Mat grey = renderedFrames(board, refinementCamera(), {hold})[0];
    const Pose pose = heldPose(board, refinementCamera(), hold);
    const std::vector<Eigen::Vector2d> places = boardCorners(board);
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Eigen::Vector2d truth =
          project(refinementCamera(), pose * Eigen::Vector3d(places[i].x(), places[i].y(), 0));
      const Eigen::Vector2d start = truth + Eigen::Vector2d(0.5, -0.4);
      const std::optional<RefinedCorner> found =
          refineCorner(grey, board, refinementCamera(), pose, {static_cast<int>(i), places[i], start});
      if (!found) continue;
      sum += (found->pixel - truth).squaredNorm();
      ++count;
    }
    EXPECT_GE(count, static_cast<int>(9 * places.size() / 10)) << text;
    EXPECT_LT(std::sqrt(sum / count), 0.05) << text;
  }
}

TEST(CornerRefinement, WhatIsCoveredIsLeftOut) {
  const Board board = parseBoard("chessboard:9x6:30mm");
  const Hold hold{0.5, 0.5, 0.75};
  cv::Mat grey = renderedFrames(board, refinementCamera(), {hold})[0];
  const Pose pose = heldPose(board, refinementCamera(), hold);
  const Eigen::Vector2d place = boardCorners(board)[20];
  const MeasuredCorner corner{20, place, project(refinementCamera(), pose * Eigen::Vector3d(place.x(), place.y(), 0))};
  ASSERT_TRUE(refineCorner(grey, board, refinementCamera(), pose, corner));
  grey(cv::Rect(static_cast<int>(corner.pixel.x()), static_cast<int>(corner.pixel.y()) - 10, 20, 20)) = 130;
  EXPECT_FALSE(refineCorner(grey, board, refinementCamera(), pose, corner)) << "half of it under a thumb";
  grey = 130;
  EXPECT_FALSE(refineCorner(grey, board, refinementCamera(), pose, corner)) << "nothing to be seen";
}

}  // namespace
}  // namespace edgeslam
