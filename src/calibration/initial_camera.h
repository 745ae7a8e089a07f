// Where the fit of a camera starts from: a focal length and the boards' poses.
#pragma once

#include <optional>
#include <vector>

#include "calibration/camera_fit.h"

namespace edgeslam {

// Pose of a board whose corners a camera sees, from the homography between the board and the bearings' plane z = 1.
// Nothing where fewer than four corners lie within 80 degrees of the axis, or no pose explains them.
std::optional<Pose> boardPose(const Camera& camera, const std::vector<MeasuredCorner>& corners);

// A camera without distortion of that model and size whose focal length explains the views, and the views' poses in it.
// Tries focal lengths from a quarter to five times the image's longer side. Nothing where none explains them.
std::optional<Camera> initialCamera(CameraModel model, int width, int height, std::vector<FittedView>& views);

}  // namespace edgeslam
