#include "calibration/calibration.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/calib3d.hpp>

#include "calibration/calibration_text.h"
#include "frames/calibration_file.h"
#include "frames/frame_source.h"
#include "unit/calibration/rendered_board.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

Camera usualCamera() {
  return {CameraModel::pinhole_radial_tangential, 480, 360, 402.3, 405.1, 243.7, 176.2,
          {0.045, -0.11, -0.0012, 0.0007}};
}
Camera wideCamera() {
  return {CameraModel::pinhole_radial_tangential, 480, 360, 270.2, 269.1, 236.1, 183.4, {-0.27, 0.07, 0.0006, -0.0009}};
}
Camera fisheyeCamera() {
  return {CameraModel::kannala_brandt, 480, 360, 182.4, 181.9, 241.3, 178.6, {0.02, -0.008, 0.002, 0, 0}};
}

struct Case {
  std::string board;
  Camera camera;
  std::string name;
};

class KnownCamera : public testing::TestWithParam<Case> {};

// The better of what a user of OpenCV gets from the same frames: all coefficients, or k3 left out.
CameraDifference plainCalibration(const std::vector<BoardView>& views, const Board& board, const Camera& truth) {
  const std::vector<Eigen::Vector2d> places = boardCorners(board);
  std::vector<std::vector<cv::Point3f>> objects;
  std::vector<std::vector<cv::Point2f>> images;
  for (const BoardView& view : views) {
    objects.emplace_back();
    images.emplace_back();
    for (const BoardCorner& corner : view.sighting.corners) {
      const Eigen::Vector2d& place = places[static_cast<std::size_t>(corner.number)];
      objects.back().emplace_back(static_cast<float>(place.x()), static_cast<float>(place.y()), 0.F);
      images.back().emplace_back(static_cast<float>(corner.pixel.x()), static_cast<float>(corner.pixel.y()));
    }
    cv::cornerSubPix(view.grey, images.back(), {4, 4}, {-1, -1}, {cv::TermCriteria::COUNT, 40, 0});
  }
  CameraDifference best{1e9, 1e9};
  for (const int flags : {0, static_cast<int>(cv::CALIB_FIX_K3)}) {
    cv::Mat matrix, distortion, rotations, translations;
    cv::calibrateCamera(objects, images, {truth.width, truth.height}, matrix, distortion, rotations, translations,
                        flags);
    Camera camera{truth.model,
                  truth.width,
                  truth.height,
                  matrix.at<double>(0, 0),
                  matrix.at<double>(1, 1),
                  matrix.at<double>(0, 2),
                  matrix.at<double>(1, 2),
                  {}};
    for (int i = 0; i < 5; ++i) camera.distortion[static_cast<std::size_t>(i)] = distortion.at<double>(i);
    const CameraDifference difference = cameraDifference(truth, camera);
    if (difference.rms_px < best.rms_px) best = difference;
  }
  return best;
}

TEST_P(KnownCamera, IsFoundAgain) {
  const Board board = parseBoard(GetParam().board);
  const Camera& truth = GetParam().camera;
  const ViewSelection selection = selectedFrom(board, renderedFrames(board, truth, goodHolds(truth)));
  ASSERT_GE(selection.views().size(), 16U) << selection.counts().no_board << " without the board";
  const Calibration found = calibrate(selection.views(), board, selection.imageSize(), {truth.model});
  const CameraDifference difference = cameraDifference(truth, found.camera);
  EXPECT_LT(difference.rms_px, 0.1);
  EXPECT_LT(difference.max_px, 0.4);
  EXPECT_NEAR(found.camera.fx / truth.fx, 1, 0.001);
  EXPECT_NEAR(found.camera.fy / truth.fy, 1, 0.001);
  EXPECT_NEAR(found.camera.cx, truth.cx, 0.4);
  EXPECT_NEAR(found.camera.cy, truth.cy, 0.4);
  EXPECT_LT(found.held_back_rms_px, 0.1);
  // The standard deviations are to be believed.
  EXPECT_LT(std::abs(found.camera.fx - truth.fx), 5 * found.sigma(0) + 0.01);
  EXPECT_LT(std::abs(found.camera.cx - truth.cx), 5 * found.sigma(2) + 0.01);
  if (truth.model == CameraModel::pinhole_radial_tangential) {
    const CameraDifference plain = plainCalibration(selection.views(), board, truth);
    EXPECT_LT(difference.rms_px, plain.rms_px + 0.01);
  }
}

INSTANTIATE_TEST_SUITE_P(Boards, KnownCamera,
                         testing::Values(Case{"chessboard:9x6:30mm", usualCamera(), "chessboard"},
                                         Case{"charuco:8x6:30mm:22mm", wideCamera(), "charuco_wide"},
                                         Case{"aprilgrid:6x5:26mm:0.3", usualCamera(), "aprilgrid"},
                                         Case{"aprilgrid:4x3:40mm:0.3", fisheyeCamera(), "aprilgrid_fisheye"},
                                         Case{"chessboard:8x5:30mm", fisheyeCamera(), "chessboard_fisheye"}),
                         [](const auto& known) { return known.param.name; });

TEST(Calibration, OfTheSharedBoardIsBetterThanThePlainOne) {
  const std::string folder = std::string(EDGESLAM_SOURCE_DIR) + "/../shared/data/calib_board";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  const Board board = parseBoard("chessboard:9x6:30mm");
  const std::unique_ptr<FrameSource> source = openFrames(folder);
  ViewSelection selection(board, {});
  while (const std::optional<Frame> frame = source->next()) selection.add(frame->index, frame->time_ns, frame->grey);
  selection.end();
  const Camera truth = *source->camera();
  const Calibration found = calibrate(selection.views(), board, selection.imageSize(), {truth.model});
  const CameraDifference difference = cameraDifference(truth, found.camera);
  const CameraDifference plain = plainCalibration(selection.views(), board, truth);
  EXPECT_LT(difference.rms_px, 0.1);
  EXPECT_LT(difference.max_px, 0.3);
  EXPECT_LT(difference.rms_px, plain.rms_px);
  EXPECT_NEAR(found.camera.fx, truth.fx, 0.1);
  EXPECT_NEAR(found.camera.cx, truth.cx, 0.15);
}

TEST(Calibration, IsWrittenAsTheProgramReadsIt) {
  const TemporaryFolder folder;
  Calibration calibration;
  for (const Camera& camera : {usualCamera(), fisheyeCamera()}) {
    calibration.camera = camera;
    calibration.sigma.setConstant(0.001);
    const std::string path =
        folder.write("camera.yaml", calibrationFileText(calibration, Board{}, "a folder\nwith: a line break"));
    const Camera read = readCalibration(path);
    EXPECT_EQ(read.model, camera.model);
    EXPECT_EQ(read.width, camera.width);
    EXPECT_LT(cameraDifference(camera, read).max_px, 1e-3);
  }
}

}  // namespace
}  // namespace edgeslam
