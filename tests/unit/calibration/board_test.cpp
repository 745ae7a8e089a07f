#include "calibration/board.h"

#include <gtest/gtest.h>

#include <set>

#include "calibration/board_drawing.h"
#include "calibration/marker_detection.h"
#include "unit/calibration/rendered_board.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

const std::vector<std::string> boards{"chessboard:9x6:30mm", "charuco:8x6:30mm:22mm", "charuco:7x5:1mm:0.6mm:4x4",
                                      "aprilgrid:6x5:88mm:0.3"};

TEST(Board, TextAndBoardAreTheSame) {
  for (const std::string& text : boards) EXPECT_EQ(boardText(parseBoard(text)), text);
  EXPECT_EQ(boardText(parseBoard("chessboard:9x6:0.0298m")), "chessboard:9x6:29.8mm");
  EXPECT_EQ(boardText(parseBoard("charuco:8x6:3cm:22 mm:5x5")), "charuco:8x6:30mm:22mm");
}

TEST(Board, WhatIsWrongIsNamed) {
  const auto parsed = [](const std::string& text) { return [text] { parseBoard(text); }; };
  expectInputError(parsed(""), "no kind of board");
  expectInputError(parsed("circles:9x6:30mm"), "circles", "chessboard:9x6:30mm");
  expectInputError(parsed("chessboard:9x6"), "2 parts");
  expectInputError(parsed("chessboard:9x6:30mm:4"), "4 parts");
  expectInputError(parsed("chessboard:9by6:30mm"), "9by6");
  expectInputError(parsed("chessboard:9x-6:30mm"), "-6");
  expectInputError(parsed("chessboard:9x6:30"), "unit", "30mm");
  expectInputError(parsed("chessboard:9x6:nanmm"), "nanmm");
  expectInputError(parsed("chessboard:9x6:mm"), "'mm'");
  expectInputError(parsed("chessboard:9x6:30km"), "30km");
  expectInputError(parsed("chessboard:9x6:20m"), "0.1mm to 10m");
  expectInputError(parsed("chessboard:2x6:30mm"), "2 x 6 inner corners", "3 to 40");
  expectInputError(parsed("charuco:8x6:30mm:30mm"), "0.3 to 0.95");
  expectInputError(parsed("charuco:8x6:30mm:22mm:9x9"), "9x9", "4x4");
  expectInputError(parsed("aprilgrid:6x6:30mm:3"), "0.05 to 1");
  expectInputError(parsed("aprilgrid:6x6:30mm:0.3mm"), "0.3mm");
  expectInputError(parsed("aprilgrid:30x30:30mm:0.3"), "900", "587");
}

TEST(Board, EveryCornerIsWhereTwoBlackAndTwoWhiteSquaresMeet) {
  for (const std::string& text : boards) {
    const Board board = parseBoard(text);
    const BoardPaint paint(board);
    const double step = 0.02 * board.square_m;
    for (const Eigen::Vector2d& corner : boardCorners(board)) {
      const auto isBlack = [&](double x, double y) { return paint.grey(corner.x() + x, corner.y() + y, 1) < 100; };
      EXPECT_EQ(isBlack(step, step), isBlack(-step, -step));
      EXPECT_EQ(isBlack(-step, step), isBlack(step, -step));
      EXPECT_NE(isBlack(step, step), isBlack(-step, step)) << text << " at " << corner.transpose();
    }
  }
}

TEST(Board, MarkersLieInWhiteSquaresAndTagsAreNumberedFromTheBottomLeft) {
  const Board charuco = parseBoard("charuco:7x5:40mm:20mm");
  EXPECT_EQ(markerCount(charuco), 17);
  std::set<std::pair<int, int>> squares;
  for (int i = 0; i < markerCount(charuco); ++i) {
    const Eigen::Vector2d square = (markerOrigin(charuco, i) / charuco.square_m).array() + 0.75;
    EXPECT_NEAR(square.x(), std::round(square.x()), 1e-9);
    const int column = static_cast<int>(std::lround(square.x())), row = static_cast<int>(std::lround(square.y()));
    EXPECT_EQ((column + row) % 2, 1);
    squares.insert({row, column});
  }
  EXPECT_EQ(squares.size(), 17U);

  const Board grid = parseBoard("aprilgrid:3x2:10mm:0.5");
  EXPECT_TRUE(markerOrigin(grid, 0).isApprox(Eigen::Vector2d(0, 0.015)));
  EXPECT_TRUE(markerOrigin(grid, 5).isApprox(Eigen::Vector2d(0.03, 0)));
}

// The code of tag 0 as its authors published it: d5d628584, 36 bits row by row from the top left.
TEST(Board, AprilTagsAreUprightAsTheirAuthorsHaveThem) {
  const cv::Mat cells = markerCells(MarkerFamily::apriltag_36h11, 0);
  ASSERT_EQ(cells.size(), cv::Size(6, 6));
  std::uint64_t code = 0;
  for (int i = 0; i < 36; ++i) code = 2 * code + cells.at<unsigned char>(i / 6, i % 6);
  EXPECT_EQ(code, 0xd5d628584U);
}

}  // namespace
}  // namespace edgeslam
