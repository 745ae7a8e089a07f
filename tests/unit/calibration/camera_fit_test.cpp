#include "calibration/camera_fit.h"

#include <gtest/gtest.h>

#include "calibration/initial_camera.h"
#include "unit/calibration/rendered_board.h"

namespace edgeslam {
namespace {

Camera pinhole() {
  return {CameraModel::pinhole_radial_tangential, 640, 480, 535.4, 539.2, 320.1, 247.6,
          {0.045, -0.11, -0.0012, 0.0007, 0.01}};
}
Camera fisheye() {
  return {CameraModel::kannala_brandt, 640, 480, 240.2, 241.1, 322.3, 236.5, {0.02, -0.008, 0.002, -0.0004, 0}};
}

std::vector<FittedView> exactViews(const Camera& camera) {
  const Board board = parseBoard("chessboard:9x6:30mm");
  const std::vector<Eigen::Vector2d> places = boardCorners(board);
  std::vector<FittedView> views;
  for (const Hold& hold : goodHolds(camera)) {
    FittedView view;
    const Pose pose = heldPose(board, camera, hold);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Eigen::Vector3d point = pose * Eigen::Vector3d(places[i].x(), places[i].y(), 0);
      view.corners.push_back({static_cast<int>(i), places[i], project(camera, point)});
    }
    views.push_back(view);
  }
  return views;
}

FitOptions allFree(const Camera& camera) {
  FitOptions options;
  options.free.fill(true);
  options.free[8] = camera.model == CameraModel::pinhole_radial_tangential;
  return options;
}

TEST(CameraFit, FindsTheCameraAgainFromExactCorners) {
  for (const Camera& truth : {pinhole(), fisheye()}) {
    std::vector<FittedView> views = exactViews(truth);
    std::optional<Camera> camera = initialCamera(truth.model, truth.width, truth.height, views);
    ASSERT_TRUE(camera);
    const FitResult fit = fitCamera(*camera, views, allFree(truth));
    EXPECT_TRUE(fit.converged);
    EXPECT_LT(rmsError(*camera, views), 1e-4);
    EXPECT_LT(cameraDifference(truth, *camera).max_px, 1e-2);
  }
}

TEST(CameraFit, AFewWrongCornersDoNotMatter) {
  const Camera truth = pinhole();
  std::vector<FittedView> views = exactViews(truth);
  for (std::size_t i = 0; i < views.size(); i += 2) views[i].corners[i].pixel.x() += 30;
  std::optional<Camera> camera = initialCamera(truth.model, truth.width, truth.height, views);
  ASSERT_TRUE(camera);
  FitOptions options = allFree(truth);
  options.huber = 0.05;
  fitCamera(*camera, views, options);
  EXPECT_LT(cameraDifference(truth, *camera).rms_px, 0.05);
}

TEST(CameraFit, ParametersThatAreNotFreeStay) {
  const Camera truth = pinhole();
  std::vector<FittedView> views = exactViews(truth);
  Camera camera = *initialCamera(truth.model, truth.width, truth.height, views);
  const Camera before = camera;
  fitCamera(camera, views, {});
  EXPECT_EQ(camera, before);
  FitOptions options = allFree(truth);
  options.free[8] = false;
  const FitResult fit = fitCamera(camera, views, options);
  EXPECT_EQ(camera.distortion[4], 0);
  const CameraMatrix covariance = parameterCovariance(fit, options, 1);
  EXPECT_EQ(covariance(8, 8), 0);
  EXPECT_GT(covariance.diagonal().head<8>().minCoeff(), 0);
}

TEST(CameraFit, TheDerivativeByTheParametersIsThatOfTheProjection) {
  const Eigen::Vector3d point(0.31, -0.22, 0.7);
  for (const Camera& camera : {pinhole(), fisheye()}) {
    const Eigen::Matrix<double, 2, camera_parameters> jacobian = parameterJacobian(camera, point);
    for (int i = 0; i < camera_parameters; ++i) {
      if (i == 8 && camera.model == CameraModel::kannala_brandt) continue;
      constexpr double kStep = 1e-6;
      const CameraVector step = kStep * CameraVector::Unit(i);
      const Eigen::Vector2d numeric =
          (project(changedCamera(camera, step), point) - project(changedCamera(camera, -step), point)) / (2 * kStep);
      EXPECT_LT((numeric - jacobian.col(i)).norm(), 1e-5) << "parameter " << i;
    }
  }
}

}  // namespace
}  // namespace edgeslam
