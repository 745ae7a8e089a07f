// Position of a board's corner from the grey values about it, given nearly right camera and pose: a blurred pattern of
// four squares is seen through the lens as it would be, and shifted until it fits (Lucas and Kanade 1981). The lens'
// distortion and the perspective are thereby allowed for, which refinements in the plain image leave in.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "calibration/board.h"
#include "calibration/camera_fit.h"

namespace edgeslam {

struct RefinedCorner {
  Eigen::Vector2d pixel;       // distorted [px]
  Eigen::Matrix2d covariance;  // [px^2], from the grey values' misfit
};

// Nothing where the corner's surroundings leave the image, do not look like the pattern (a finger, a reflection), or
// where it lies more than 1.5 px from where `corner.pixel` says.
std::optional<RefinedCorner> refineCorner(const cv::Mat& grey, const Board& board, const Camera& camera,
                                          const Pose& camera_T_board, const MeasuredCorner& corner);

}  // namespace edgeslam
