#include "calibration/view_selection.h"

#include <gtest/gtest.h>

#include "calibration/coverage.h"
#include "unit/calibration/rendered_board.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

constexpr std::int64_t still_ns = 500'000'000, kNext_ns = 33'000'000;

class SelectedViews : public testing::Test {
 protected:
  cv::Mat frame(const Hold& hold, const RenderOptions& options = {}) const {
    return renderer_.render(heldPose(board_, camera_, hold), options, 1);
  }
  ViewDecision add(const cv::Mat& grey, std::int64_t after_ns) {
    return selection_.add(index_++, time_ns_ += after_ns, grey);
  }

  Board board_ = parseBoard("chessboard:7x5:30mm");
  Camera camera_{CameraModel::pinhole_radial_tangential, 320, 240, 300, 300, 159.5, 119.5, {}};
  BoardRenderer renderer_{board_, camera_};
  ViewSelection selection_{board_, {}};
  std::int64_t index_ = 0, time_ns_ = 0;
};

TEST_F(SelectedViews, StillsAreTakenWhereTheyDiffer) {
  EXPECT_EQ(add(frame({0.4, 0.5, 0.6}), still_ns), ViewDecision::waiting);
  EXPECT_EQ(add(frame({0.6, 0.5, 0.6}), still_ns), ViewDecision::taken);
  EXPECT_EQ(add(frame({0.61, 0.5, 0.6}), still_ns), ViewDecision::taken) << "the one before";
  EXPECT_EQ(add(frame({0.6, 0.5, 0.6, 0.4}), still_ns), ViewDecision::waiting) << "tilted";
  EXPECT_EQ(add(frame({0.6, 0.5, 0.61, 0.41}), still_ns), ViewDecision::taken);
  selection_.end();
  ASSERT_EQ(selection_.views().size(), 3U);
  EXPECT_EQ(selection_.views()[2].frame, 3);
  EXPECT_EQ(selection_.counts().not_new, 2);
}

TEST_F(SelectedViews, InAVideoTheBoardMustStandStill) {
  add(frame({0.40, 0.5, 0.6}), still_ns);
  EXPECT_EQ(add(frame({0.42, 0.5, 0.6}), kNext_ns), ViewDecision::moving) << "by six pixels";
  EXPECT_EQ(add(frame({0.42, 0.5, 0.6}), kNext_ns), ViewDecision::not_looked_at) << "too soon";
  EXPECT_EQ(add(frame({0.42, 0.5, 0.6}), 4 * kNext_ns), ViewDecision::waiting);
  EXPECT_EQ(add(frame({0.421, 0.5, 0.6}), kNext_ns), ViewDecision::taken);
  EXPECT_EQ(selection_.counts().moving, 1);
}

TEST_F(SelectedViews, BlurredOnesAreNot) {
  RenderOptions blurred;
  blurred.blur_px = 3;
  const ViewDecision decision = add(frame({0.5, 0.5, 0.7}, blurred), still_ns);
  EXPECT_TRUE(decision == ViewDecision::blurred || decision == ViewDecision::no_board);
  RenderOptions shaken;
  shaken.motion_px = {9, 3};
  add(frame({0.5, 0.5, 0.7}, shaken), still_ns);
  selection_.end();
  EXPECT_TRUE(selection_.views().empty());
}

TEST_F(SelectedViews, AnotherImageSizeIsAnError) {
  add(frame({0.5, 0.5, 0.7}), still_ns);
  expectInputError([&] { add(cv::Mat(480, 640, CV_8U, cv::Scalar(0)), still_ns); }, "640 x 480", "320 x 240",
                   "one image size");
}

TEST_F(SelectedViews, TheTiltHasTheSidesThatTheGuidanceNames) {
  const auto tiltOf = [&](double turned, double nodded) {
    const std::optional<BoardSighting> seen = detectBoard(frame({0.5, 0.5, 0.6, turned, nodded}), board_);
    return lookOf(*seen, board_, {320, 240}, 300).tilt_rad;
  };
  // A board turned about the vertical axis by the right hand (x towards -z) faces left in the image.
  EXPECT_NEAR(tiltOf(0.4, 0).x(), -0.4, 0.05);
  EXPECT_NEAR(tiltOf(0, 0.4).y(), 0.4, 0.05);
  EXPECT_NEAR(tiltOf(0, 0).norm(), 0, 0.06);
}

TEST_F(SelectedViews, CoverageTellsWhatIsMissingUntilNothingIs) {
  const ViewCoverage none = coverageOf({}, {320, 240});
  EXPECT_EQ(none.share(), 0);
  EXPECT_EQ(coverageProblems(none).size(), 1U);
  add(frame({0.3, 0.3, 0.4}), still_ns);
  selection_.end();
  const ViewCoverage one = coverageOf(selection_.views(), {320, 240});
  const std::vector<std::string> wishes = missingViews(one);
  ASSERT_GE(wishes.size(), 3U);
  EXPECT_NE(wishes[0].find("bottom right"), std::string::npos);
  EXPECT_NE(wishes[1].find("to the left, to the right, up, down"), std::string::npos);
  EXPECT_EQ(coverageMap(one).size(), static_cast<std::size_t>(coverage_rows));

  ViewCoverage all = one;
  all.views = 30;
  all.views_in_region.fill(5);
  all.tilted_left = all.tilted_right = all.tilted_up = all.tilted_down = 3;
  all.largest_filled = 0.5;
  EXPECT_TRUE(missingViews(all).empty());
  EXPECT_TRUE(coverageProblems(all).empty());
}

}  // namespace
}  // namespace edgeslam
