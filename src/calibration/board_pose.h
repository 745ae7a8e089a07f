// Where a camera is before a board.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "calibration/board.h"
#include "geometry/camera.h"
#include "geometry/pose.h"

namespace edgeslam {

// board_T_camera [m] by the board's corners in a grey image (CV_8U) of a calibrated camera; nothing where the board is
// not found, or its corners do not fit one pose.
std::optional<Pose> cameraBeforeBoard(const cv::Mat& grey, const Board& board, const Camera& camera);

// The same where the corners of a chessboard are counted from its other end, as they may be in any image.
Pose fromOtherEnd(const Board& board, const Pose& board_T_camera);

}  // namespace edgeslam
