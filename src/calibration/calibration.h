// From views of a board to a camera: fit, removal of what does not belong, refinement of the corners by what is known
// then, choice of the model, and a check on views that were held back.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/board.h"
#include "calibration/camera_fit.h"
#include "calibration/view_selection.h"

namespace edgeslam {

struct CalibrationOptions {
  std::optional<CameraModel> model;  // nothing: the one that predicts the views held back better
};

struct Calibration {
  Camera camera;
  CameraVector sigma = CameraVector::Zero();  // standard deviations of fx fy cx cy and the distortion
  int views = 0, corners = 0;                 // that it is made of
  double rms_px = 0;                          // reprojection error of the views that it is made of
  int held_back_views = 0;
  double held_back_rms_px = 0;       // reprojection error in views that were left out of a fit made for that
  double expected_rms_px = 0;        // standard deviation of a bearing's pixel, over the image
  double expected_max_px = 0;        // where it is largest
  std::vector<std::string> remarks;  // what was left out and why, what was chosen
};

// Throws InputError, with every reason, where the views make no calibration.
Calibration calibrate(const std::vector<BoardView>& views, const Board& board, cv::Size size,
                      const CalibrationOptions& options);

// A fit to the corners as they were detected, for showing how far it is: its root mean square error [px], or nothing
// where the views are too few.
std::optional<double> quickError(const std::vector<BoardView>& views, const Board& board, cv::Size size);

// Why the board is not as described, by what the views show: the gap of an AprilGrid, a chessboard that goes on; empty
// where all agrees.
std::string boardMismatch(const std::vector<BoardView>& views, const Board& board);

}  // namespace edgeslam
