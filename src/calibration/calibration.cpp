#include "calibration/calibration.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "calibration/coverage.h"
#include "calibration/initial_camera.h"
#include "calibration/model_fit.h"
#include "edgeslam/input_error.h"
#include "files/format_text.h"

namespace edgeslam {
namespace {

constexpr std::size_t held_back_one_in = 5;
constexpr double fisheye_gain = 0.9;      // held-back error that the fisheye model must come below, of the pinhole's
constexpr double largest_error_px = 0.7;  // held-back, at an image 640 px wide
constexpr double largest_focal_sigma = 0.005;  // of the focal length
constexpr double largest_expected_px = 3;      // standard deviation of a bearing's pixel, at an image 640 px wide

[[noreturn]] void refuse(const std::vector<std::string>& reasons) {
  std::string message = "these views make no calibration: ";
  for (std::size_t i = 0; i < reasons.size(); ++i) message += (i > 0 ? "; " : "") + reasons[i];
  throw InputError(message);
}

std::vector<ImagedView> imagedViews(const std::vector<BoardView>& views, const Board& board) {
  const std::vector<Eigen::Vector2d> places = boardCorners(board);
  std::vector<ImagedView> imaged;
  for (const BoardView& view : views) {
    ImagedView& added = imaged.emplace_back();
    added.frame = view.frame;
    added.grey = view.grey;
    for (const BoardCorner& corner : view.sighting.corners) {
      added.fitted.corners.push_back({corner.number, places[static_cast<std::size_t>(corner.number)], corner.pixel});
    }
  }
  return imaged;
}

struct HeldBackCheck {
  CameraModel model = CameraModel::pinhole_radial_tangential;
  double rms_px = 0;
  int views = 0;
};

// Fits without every fifth view and looks how well those are predicted.
std::optional<HeldBackCheck> checkHeldBack(CameraModel model, cv::Size size, const std::vector<ImagedView>& views,
                                           const Board& board) {
  std::vector<ImagedView> used, held_back;
  for (std::size_t i = 0; i < views.size(); ++i) {
    (i % held_back_one_in == held_back_one_in / 2 ? held_back : used).push_back(views[i]);
  }
  const std::optional<ModelFit> fit = fitModel(model, size, used, board);
  if (!fit) return std::nullopt;
  std::vector<FittedView> placed = placeViews(fit->camera, held_back, board);
  // A view that would be left out of a fit says nothing about the camera.
  std::vector<double> errors;
  for (const FittedView& view : placed) errors.push_back(rmsError(fit->camera, {view}));
  std::vector<double> sorted = errors;
  std::sort(sorted.begin(), sorted.end());
  std::vector<FittedView> good;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (errors[i] <= std::max(3 * sorted[sorted.size() / 2], 0.3)) good.push_back(placed[i]);
  }
  if (good.empty()) return std::nullopt;
  return HeldBackCheck{model, rmsError(fit->camera, good), static_cast<int>(good.size())};
}

// Standard deviation of the pixel of a bearing, over the image.
void expectError(const ModelFit& fit, Calibration& calibration) {
  constexpr int steps = 16;
  double sum = 0;
  for (int row = 0; row <= steps; ++row) {
    for (int column = 0; column <= steps; ++column) {
      const Eigen::Vector2d pixel(column * (fit.camera.width - 1.0) / steps, row * (fit.camera.height - 1.0) / steps);
      const Eigen::Matrix<double, 2, camera_parameters> jacobian =
          parameterJacobian(fit.camera, bearing(fit.camera, pixel));
      const double variance = (jacobian * fit.covariance * jacobian.transpose()).trace();
      sum += variance;
      calibration.expected_max_px = std::max(calibration.expected_max_px, std::sqrt(variance));
    }
  }
  calibration.expected_rms_px = std::sqrt(sum / ((steps + 1) * (steps + 1)));
}

std::vector<std::string> resultProblems(const Calibration& calibration, const Board& board) {
  std::vector<std::string> problems;
  const Camera& camera = calibration.camera;
  const double scale = std::max(1.0, camera.width / 640.0);
  if (!(calibration.held_back_rms_px <= largest_error_px * scale)) {
    problems.push_back("corners in views held back are off by " + formatted("%.2f px", calibration.held_back_rms_px) +
                       " (" + formatted("%.2f", largest_error_px * scale) +
                       " is the limit): is the board flat, and is it " + boardText(board) + "?");
  }
  const double focal_sigma = std::max(calibration.sigma(0) / camera.fx, calibration.sigma(1) / camera.fy);
  if (!(focal_sigma <= largest_focal_sigma)) {
    problems.push_back("the focal length is known to " + formatted("%.1f %%", 100 * focal_sigma) +
                       " only; add views of the board tilted by 20 to 45 degrees, near and far");
  }
  if (!(calibration.expected_max_px <= largest_expected_px * scale)) {
    problems.push_back("the lens is known to " + formatted("%.1f px", calibration.expected_max_px) +
                       " only at the image's worst place; add views with the board in the image's corners");
  }
  if (!(camera.cx >= 0 && camera.cx <= camera.width - 1 && camera.cy >= 0 && camera.cy <= camera.height - 1)) {
    problems.emplace_back("the centre comes out outside the image");
  }
  return problems;
}

}  // namespace

Calibration calibrate(const std::vector<BoardView>& views, const Board& board, cv::Size size,
                      const CalibrationOptions& options) {
  const std::vector<std::string> missing = coverageProblems(coverageOf(views, size));
  if (!missing.empty()) refuse(missing);
  if (const std::string mismatch = boardMismatch(views, board); !mismatch.empty()) refuse({mismatch});
  const std::vector<ImagedView> imaged = imagedViews(views, board);

  Calibration calibration;
  std::optional<HeldBackCheck> best;
  for (const CameraModel model : {CameraModel::pinhole_radial_tangential, CameraModel::kannala_brandt}) {
    if (options.model && *options.model != model) continue;
    const std::optional<HeldBackCheck> check = checkHeldBack(model, size, imaged, board);
    if (!check) continue;
    calibration.remarks.push_back(
        std::string(model == CameraModel::kannala_brandt ? "kannala_brandt" : "pinhole_radial_tangential") +
        ": error in views held back " + formatted("%.3f px", check->rms_px));
    const bool is_better = best && check->rms_px < fisheye_gain * best->rms_px;
    if (!best || is_better) best = check;
  }
  const std::optional<ModelFit> fit = best ? fitModel(best->model, size, imaged, board) : std::nullopt;
  if (!fit) refuse({"no camera explains them: is the board " + boardText(board) + "?"});

  calibration.camera = fit->camera;
  calibration.sigma = fit->covariance.diagonal().cwiseMax(0).cwiseSqrt();
  calibration.views = static_cast<int>(fit->views.size());
  for (const ImagedView& view : fit->views) calibration.corners += static_cast<int>(view.fitted.corners.size());
  calibration.rms_px = rmsError(fit->camera, fittedViews(fit->views));
  calibration.held_back_views = best->views;
  calibration.held_back_rms_px = best->rms_px;
  calibration.remarks.insert(calibration.remarks.end(), fit->remarks.begin(), fit->remarks.end());
  expectError(*fit, calibration);
  std::vector<std::string> problems = resultProblems(calibration, board);
  if (2 * fit->views.size() < views.size()) {
    problems.push_back("only " + std::to_string(fit->views.size()) + " of " + std::to_string(views.size()) +
                       " views agree with each other");
  }
  if (!problems.empty()) refuse(problems);
  return calibration;
}

std::optional<double> quickError(const std::vector<BoardView>& views, const Board& board, cv::Size size) {
  if (views.size() < 4) return std::nullopt;
  std::vector<FittedView> fitted = fittedViews(imagedViews(views, board));
  std::optional<Camera> camera = initialCamera(CameraModel::pinhole_radial_tangential, size.width, size.height, fitted);
  if (!camera) return std::nullopt;
  FitOptions options;
  std::fill_n(options.free.begin(), 8, true);
  options.iterations = 20;
  fitCamera(*camera, fitted, options);
  return rmsError(*camera, fitted);
}

}  // namespace edgeslam
