#include "calibration/board_detection.h"

#include <gtest/gtest.h>

#include "unit/calibration/rendered_board.h"

namespace edgeslam {
namespace {

Camera camera() {
  return {CameraModel::pinhole_radial_tangential, 480, 360, 402.3, 405.1, 243.7, 176.2, {-0.1, 0.02, 0, 0, 0}};
}

class DetectedBoard : public testing::TestWithParam<std::string> {};

TEST_P(DetectedBoard, HasItsCornersWhereTheyAre) {
  const Board board = parseBoard(GetParam());
  const std::vector<Hold> holds{{0.5, 0.5, 0.6, 0.1, 0, 0.2}, {0.45, 0.5, 0.5, 0.5, 0.1, -0.6}};
  const std::vector<cv::Mat> frames = renderedFrames(board, camera(), holds);
  const std::vector<Eigen::Vector2d> places = boardCorners(board);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::optional<BoardSighting> seen = detectBoard(frames[i], board);
    ASSERT_TRUE(seen);
    EXPECT_GE(seen->corners.size(), 8 * places.size() / 10);
    const Pose pose = heldPose(board, camera(), holds[i]);
    std::size_t good = 0;
    const Eigen::Vector2d first = project(camera(), pose * Eigen::Vector3d(places[0].x(), places[0].y(), 0));
    for (const BoardCorner& corner : numberedFrom(seen->corners, board, first)) {
      const Eigen::Vector2d& place = places[static_cast<std::size_t>(corner.number)];
      const Eigen::Vector2d truth = project(camera(), pose * Eigen::Vector3d(place.x(), place.y(), 0));
      good += (corner.pixel - truth).norm() < 0.5 ? 1 : 0;
    }
    EXPECT_GE(good, 9 * seen->corners.size() / 10);
    EXPECT_NEAR(seen->blur_px, 0.65, 0.45);
  }
}

INSTANTIATE_TEST_SUITE_P(Boards, DetectedBoard,
                         testing::Values("chessboard:9x6:30mm", "charuco:8x6:30mm:22mm", "aprilgrid:5x4:30mm:0.3"));

TEST(BoardDetection, ABoardWithMarkersMayBeSeenInPart) {
  const Board board = parseBoard("charuco:8x6:30mm:22mm");
  const std::vector<cv::Mat> frames = renderedFrames(board, camera(), {{0.2, 0.7, 0.7, 0, 0.2, 0.3}});
  const std::optional<BoardSighting> seen = detectBoard(frames[0], board);
  ASSERT_TRUE(seen);
  EXPECT_LT(seen->corners.size(), boardCorners(board).size());
}

TEST(BoardDetection, NothingIsFoundWhereThereIsNothing) {
  cv::Mat noise(360, 480, CV_8U);
  cv::RNG random(7);
  random.fill(noise, cv::RNG::UNIFORM, 0, 255);
  for (const char* text : {"chessboard:9x6:30mm", "charuco:8x6:30mm:22mm", "aprilgrid:5x4:30mm:0.3"}) {
    EXPECT_FALSE(detectBoard(noise, parseBoard(text)));
    EXPECT_FALSE(detectBoard(cv::Mat(360, 480, CV_8U, cv::Scalar(128)), parseBoard(text)));
    EXPECT_FALSE(detectBoard(cv::Mat(3, 2, CV_8U, cv::Scalar(128)), parseBoard(text)));
  }
}

TEST(BoardDetection, AnotherBoardIsNamed) {
  const auto seen = [](const std::string& shown, const std::string& expected) {
    const std::vector<cv::Mat> frames = renderedFrames(parseBoard(shown), camera(), {{0.5, 0.5, 0.75, 0.1, 0, 0}});
    return otherBoardSeen(frames[0], parseBoard(expected));
  };
  EXPECT_EQ(seen("chessboard:8x5:30mm", "chessboard:9x6:30mm"), "a chessboard of 8 x 5 inner corners");
  EXPECT_EQ(seen("chessboard:9x6:30mm", "chessboard:9x6:30mm"), "");
  EXPECT_NE(seen("aprilgrid:5x4:30mm:0.3", "charuco:8x6:30mm:22mm").find("AprilTags 36h11"), std::string::npos);
  EXPECT_NE(seen("charuco:6x4:30mm:22mm:4x4", "charuco:6x4:30mm:22mm").find("4 x 4 cells"), std::string::npos);
}

}  // namespace
}  // namespace edgeslam
