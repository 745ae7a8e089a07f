// Where a camera is before a board that it sees.
#include "calibration/board_pose.h"

#include <gtest/gtest.h>

#include "geometry/angles.h"
#include "unit/calibration/rendered_board.h"

namespace edgeslam {
namespace {

TEST(BoardPose, IsThatOfTheCameraThatSeesIt) {
  const Board board = parseBoard("chessboard:8x5:30mm");
  const Camera camera{CameraModel::pinhole_radial_tangential, 320, 240, 290, 291, 161, 118, {0.03, -0.05, 0, 0, 0}};
  const BoardRenderer renderer(board, camera);
  int found = 0;
  for (const Hold& hold : goodHolds(camera)) {
    const Pose expected = heldPose(board, camera, hold).inverse();
    auto pose = cameraBeforeBoard(renderer.render(expected.inverse(), {}, 1), board, camera);
    if (!pose) continue;
    ++found;
    if (rotationAngle(pose->rotation, expected.rotation) > M_PI / 2) pose = fromOtherEnd(board, *pose);
    EXPECT_LT(rotationAngle(pose->rotation, expected.rotation), radians(0.4));
    EXPECT_LT((pose->translation - expected.translation).norm(), 0.01 * expected.translation.norm());
  }
  EXPECT_GT(found, 10);
  EXPECT_FALSE(cameraBeforeBoard(cv::Mat(240, 320, CV_8U, cv::Scalar(90)), board, camera));
}

}  // namespace
}  // namespace edgeslam
