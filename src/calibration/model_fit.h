// One camera model fitted to views of a board, robustly and with refined corners.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calibration/board.h"
#include "calibration/camera_fit.h"

namespace edgeslam {

// A view with its image; views that are left out lose their corners.
struct ImagedView {
  std::int64_t frame = 0;
  cv::Mat grey;
  FittedView fitted;
};

struct ModelFit {
  Camera camera;
  std::vector<ImagedView> views;  // those that were kept
  FitOptions options;
  CameraMatrix covariance = CameraMatrix::Zero();
  std::vector<std::string> remarks;
};

// Nothing where no camera of that model explains the views.
std::optional<ModelFit> fitModel(CameraModel model, cv::Size size, std::vector<ImagedView> views, const Board& board);

// Poses and refined corners of the views in a camera that stays as it is. Views whose pose is not found are left out.
std::vector<FittedView> placeViews(const Camera& camera, const std::vector<ImagedView>& views, const Board& board);

std::vector<FittedView> fittedViews(const std::vector<ImagedView>& views);

}  // namespace edgeslam
