// Sets of views that make no calibration, each refused with its reason.
#include <gtest/gtest.h>

#include "calibration/calibration.h"
#include "unit/calibration/rendered_board.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

class RefusedViews : public testing::Test {
 protected:
  // Views of `shown`, as if it were `told`.
  template <typename... Reasons>
  void expectRefusalAs(const std::string& told, const std::string& shown, const std::vector<Hold>& holds,
                       const Reasons&... reasons) {
    const Board board = parseBoard(told);
    const ViewSelection selection = selectedFrom(board, renderedFrames(parseBoard(shown), camera_, holds));
    expectInputError([&] { calibrate(selection.views(), board, selection.imageSize(), {camera_.model}); }, reasons...);
  }
  template <typename... Reasons>
  void expectRefusal(const std::vector<Hold>& holds, const Reasons&... reasons) {
    expectRefusalAs(board_, board_, holds, reasons...);
  }

  Camera camera_{CameraModel::pinhole_radial_tangential, 320, 240, 290, 291, 161, 118, {0.03, -0.05, 0, 0, 0}};
  std::vector<Hold> good_ = goodHolds(camera_);
  std::string board_ = "chessboard:7x5:30mm";
};

TEST_F(RefusedViews, TooFew) {
  expectRefusal({good_.begin(), good_.begin() + 8}, "usable views, at least 10 are needed");
  expectInputError([&] { calibrate({}, parseBoard(board_), {320, 240}, {}); }, "0 usable views");
}

TEST_F(RefusedViews, AllFrontal) {
  for (Hold& hold : good_) hold.turned = hold.nodded = 0;
  expectRefusal(good_, "frontal", "focal length", "20 to 45 degrees");
}

TEST_F(RefusedViews, CornersOfTheImageNotCovered) {
  for (Hold& hold : good_) {
    hold.x = 0.35 + 0.1 * hold.x;
    hold.width = std::min(hold.width, 0.5);
  }
  expectRefusal(good_, "no view has the board in these parts of the image", "top right");
}

TEST_F(RefusedViews, ABoardTooFarAway) {
  for (Hold& hold : good_) {
    hold.width = 0.22;
    hold.x = 0.5 + 1.6 * (hold.x - 0.5);
    hold.y = 0.5 + 1.6 * (hold.y - 0.5);
  }
  expectRefusal(good_, "% of the image at most", "nearer");
}

TEST_F(RefusedViews, ALargerBoardThanTold) {
  const Board told = parseBoard("chessboard:6x5:30mm");
  std::vector<BoardView> views;
  for (std::size_t i = 0; i < good_.size(); ++i) {
    BoardView view;
    view.grey = renderedFrames(parseBoard(board_), camera_, {good_[i]})[0];
    views.push_back(view);
  }
  EXPECT_EQ(boardMismatch(views, told), "a chessboard of 7 x 5 inner corners is seen, not one of 6 x 5 inner corners");
  EXPECT_EQ(boardMismatch(views, parseBoard(board_)), "");
}

TEST_F(RefusedViews, AnAprilGridWithOtherGaps) {
  expectRefusalAs("aprilgrid:4x3:40mm:0.2", "aprilgrid:4x3:40mm:0.3", good_, "gaps between the tags look like 0.3",
                  "not 0.20");
}

TEST_F(RefusedViews, OfABoardThatIsBent) {
  const Board board = parseBoard(board_);
  ViewSelection selection = selectedFrom(board, renderedFrames(board, camera_, good_));
  // A fold along the middle, 5 mm in a board of 210: as if the farther half stood elsewhere in each view.
  std::vector<BoardView> views = selection.views();
  const std::vector<Eigen::Vector2d> places = boardCorners(board);
  const BoardRenderer renderer(board, camera_);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Hold& hold = good_[static_cast<std::size_t>(views[i].frame)];
    const Pose pose = heldPose(board, camera_, hold);
    Pose folded = pose;
    folded.rotation = pose.rotation * Eigen::AngleAxisd(0.12, Eigen::Vector3d::UnitY());
    folded.translation =
        pose * Eigen::Vector3d(places[3].x(), 0, 0) - folded.rotation * Eigen::Vector3d(places[3].x(), 0, 0);
    const cv::Mat other = renderer.render(folded, {}, i);
    // The half beyond the fold is taken from the turned board.
    for (int y = 0; y < other.rows; ++y) {
      for (int x = 0; x < other.cols; ++x) {
        const Pose inverse = folded.inverse();
        const Eigen::Vector3d ray = inverse.rotation * bearing(camera_, {x, y});
        const double on_board = inverse.translation.x() - inverse.translation.z() / ray.z() * ray.x();
        if (on_board > places[3].x()) views[i].grey.at<unsigned char>(y, x) = other.at<unsigned char>(y, x);
      }
    }
    if (const std::optional<BoardSighting> seen = detectBoard(views[i].grey, board)) views[i].sighting = *seen;
  }
  expectInputError([&] { calibrate(views, board, selection.imageSize(), {camera_.model}); }, "no calibration", "board");
}

}  // namespace
}  // namespace edgeslam
