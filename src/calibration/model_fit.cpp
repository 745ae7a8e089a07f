#include "calibration/model_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "calibration/corner_refinement.h"
#include "calibration/initial_camera.h"
#include "files/format_text.h"
#include "geometry/median.h"

namespace edgeslam {
namespace {

constexpr double detected_sigma_px = 0.15;        // of corners as they are detected
constexpr double refined_sigma_px = 0.01;         // least, whatever the grey values say
constexpr double outlier = 5;                     // standard deviations
constexpr double least_outlier_px = 0.1;          // nothing is left out for less
constexpr double outlier_view = 3;                // times the median view's error
constexpr double significant = 4;                 // standard deviations of a coefficient
constexpr std::size_t fewest_fitted_corners = 6;  // of a view
constexpr int refinements = 2;

std::string errorText(double value) { return formatted("%.2f px", value); }

// Poses and camera are moved as one.
FitResult fitAll(Camera& camera, std::vector<ImagedView>& views, const FitOptions& options) {
  std::vector<FittedView> fitted = fittedViews(views);
  const FitResult result = fitCamera(camera, fitted, options);
  for (std::size_t i = 0; i < views.size(); ++i) views[i].fitted = std::move(fitted[i]);
  return result;
}

double whitenedError(const Camera& camera, const FittedView& view, const MeasuredCorner& corner) {
  return (corner.whitening * cornerError(camera, view.camera_T_board, corner)).norm();
}

// By how much the errors are larger than thought, squared: from their median, which outliers do not move.
double varianceFactor(const Camera& camera, const std::vector<ImagedView>& views) {
  std::vector<double> squares;
  for (const ImagedView& view : views) {
    for (const MeasuredCorner& corner : view.fitted.corners) {
      squares.push_back(std::pow(whitenedError(camera, view.fitted, corner), 2));
    }
  }
  constexpr double median_of_two = 1.386;  // of the chi-squared distribution with two degrees of freedom
  return std::max(medianOr(0.0, squares) / median_of_two, 1e-6);
}

// Of the corners' distances [px]: single bad ones do not make a bad view.
double medianError(const Camera& camera, const FittedView& view) {
  std::vector<double> errors;
  for (const MeasuredCorner& corner : view.corners) {
    errors.push_back(cornerError(camera, view.camera_T_board, corner).norm());
  }
  return medianOr(0.0, errors);
}

void dropOutlierViews(const Camera& camera, ModelFit& fit) {
  std::vector<double> errors;
  for (const ImagedView& view : fit.views) errors.push_back(medianError(camera, view.fitted));
  const double usual = medianOr(0.0, errors);
  const double limit = std::max(outlier_view * usual, 0.3);
  std::vector<ImagedView> kept;
  for (std::size_t i = 0; i < fit.views.size(); ++i) {
    if (errors[i] <= limit) {
      kept.push_back(fit.views[i]);
      continue;
    }
    fit.remarks.push_back("frame " + std::to_string(fit.views[i].frame) + " left out: its corners are off by " +
                          errorText(errors[i]) + ", " + errorText(usual) + " in others");
  }
  fit.views = std::move(kept);
}

// Returns how many went.
int dropOutlierCorners(const Camera& camera, std::vector<ImagedView>& views) {
  const double limit = outlier * std::sqrt(varianceFactor(camera, views));
  int dropped = 0;
  for (ImagedView& view : views) {
    std::vector<MeasuredCorner> kept;
    for (const MeasuredCorner& corner : view.fitted.corners) {
      const double error_px = cornerError(camera, view.fitted.camera_T_board, corner).norm();
      if (error_px < least_outlier_px || whitenedError(camera, view.fitted, corner) <= limit) {
        kept.push_back(corner);
      } else {
        ++dropped;
      }
    }
    view.fitted.corners = std::move(kept);
  }
  return dropped;
}

void dropPoorViews(ModelFit& fit) {
  std::vector<ImagedView> kept;
  for (const ImagedView& view : fit.views) {
    if (view.fitted.corners.size() >= fewest_fitted_corners) {
      kept.push_back(view);
    } else {
      fit.remarks.push_back("frame " + std::to_string(view.frame) +
                            " left out: " + std::to_string(view.fitted.corners.size()) + " of its corners are good");
    }
  }
  fit.views = std::move(kept);
}

// All of the board's corners that should be in the image, where camera and pose say: also those that were not detected,
// or not well.
std::vector<MeasuredCorner> predictedCorners(const Camera& camera, const Pose& camera_T_board,
                                             const std::vector<Eigen::Vector2d>& places) {
  constexpr double border_px = 3;
  std::vector<MeasuredCorner> predicted;
  for (std::size_t i = 0; i < places.size(); ++i) {
    MeasuredCorner corner{static_cast<int>(i), places[i], {0, 0}};
    corner.pixel = cornerError(camera, camera_T_board, corner);
    if (insideImage(camera, corner.pixel, border_px)) predicted.push_back(corner);
  }
  return predicted;
}

// Returns how many corners are not as they should look; they are left out.
int refineCorners(const Camera& camera, const Board& board, std::vector<ImagedView>& views) {
  const std::vector<Eigen::Vector2d> places = boardCorners(board);
  int lost = 0;
  for (ImagedView& view : views) {
    const Pose& pose = view.fitted.camera_T_board;
    std::vector<MeasuredCorner> refined;
    for (MeasuredCorner corner : predictedCorners(camera, pose, places)) {
      const std::optional<RefinedCorner> found = refineCorner(view.grey, board, camera, pose, corner);
      if (!found) {
        ++lost;
        continue;
      }
      const Eigen::Matrix2d covariance =
          found->covariance + refined_sigma_px * refined_sigma_px * Eigen::Matrix2d::Identity();
      corner.pixel = found->pixel;
      corner.whitening = Eigen::Matrix2d(covariance.llt().matrixL()).inverse();
      refined.push_back(corner);
    }
    view.fitted.corners = std::move(refined);
  }
  return lost;
}

// Focal lengths, centre, and the coefficients that every lens has.
FitOptions firstTerms(CameraModel model) {
  FitOptions options;
  const std::size_t terms = model == CameraModel::kannala_brandt ? 6 : 8;
  std::fill_n(options.free.begin(), terms, true);
  return options;
}

CameraMatrix covarianceOf(const ModelFit& fit, const FitResult& result) {
  return parameterCovariance(result, fit.options, varianceFactor(fit.camera, fit.views));
}

// Takes in higher coefficients as long as each is significant: those that are not add noise to the image's corners.
void addSignificantTerms(ModelFit& fit) {
  const std::size_t end = fit.camera.model == CameraModel::kannala_brandt ? 8 : 9;
  for (std::size_t term = fit.camera.model == CameraModel::kannala_brandt ? 6 : 8; term < end; ++term) {
    ModelFit tried = fit;
    tried.options.free[term] = true;
    const FitResult result = fitAll(tried.camera, tried.views, tried.options);
    tried.covariance = covarianceOf(tried, result);
    const auto i = static_cast<Eigen::Index>(term);
    const double sigma = std::sqrt(tried.covariance(i, i));
    if (!(std::abs(tried.camera.distortion[term - 4]) > significant * sigma)) return;
    fit = std::move(tried);
  }
}

}  // namespace

std::vector<FittedView> fittedViews(const std::vector<ImagedView>& views) {
  std::vector<FittedView> fitted;
  for (const ImagedView& view : views) fitted.push_back(view.fitted);
  return fitted;
}

std::optional<ModelFit> fitModel(CameraModel model, cv::Size size, std::vector<ImagedView> views, const Board& board) {
  ModelFit fit;
  fit.views = std::move(views);
  for (ImagedView& view : fit.views) {
    for (MeasuredCorner& corner : view.fitted.corners) {
      corner.whitening = Eigen::Matrix2d::Identity() / detected_sigma_px;
    }
  }
  std::vector<FittedView> fitted = fittedViews(fit.views);
  const std::optional<Camera> start = initialCamera(model, size.width, size.height, fitted);
  if (!start) return std::nullopt;
  for (std::size_t i = 0; i < fitted.size(); ++i) fit.views[i].fitted = std::move(fitted[i]);
  fit.camera = *start;
  fit.options = firstTerms(model);
  fitAll(fit.camera, fit.views, fit.options);
  dropOutlierViews(fit.camera, fit);
  fitAll(fit.camera, fit.views, fit.options);

  int unlike = 0, outliers = 0;
  for (int i = 0; i < refinements; ++i) {
    unlike = refineCorners(fit.camera, board, fit.views);
    dropPoorViews(fit);
    if (fit.views.size() < 3) return std::nullopt;
    fitAll(fit.camera, fit.views, fit.options);
    addSignificantTerms(fit);
    outliers = dropOutlierCorners(fit.camera, fit.views);
  }
  dropOutlierViews(fit.camera, fit);
  dropPoorViews(fit);
  if (fit.views.size() < 3) return std::nullopt;
  fit.covariance = covarianceOf(fit, fitAll(fit.camera, fit.views, fit.options));
  if (unlike > 0)
    fit.remarks.push_back(std::to_string(unlike) + " corners left out: not sharp, covered or at the image's border");
  if (outliers > 0)
    fit.remarks.push_back(std::to_string(outliers) + " corners left out: off by more than five standard deviations");
  return fit;
}

std::vector<FittedView> placeViews(const Camera& camera, const std::vector<ImagedView>& views, const Board& board) {
  std::vector<ImagedView> placed;
  for (ImagedView view : views) {
    const std::optional<Pose> pose = boardPose(camera, view.fitted.corners);
    if (!pose) continue;
    view.fitted.camera_T_board = *pose;
    placed.push_back(view);
  }
  Camera fixed = camera;
  fitAll(fixed, placed, {});
  refineCorners(fixed, board, placed);
  fitAll(fixed, placed, {});
  return fittedViews(placed);
}

}  // namespace edgeslam
