// P7: a correspondence in three views must lie, in the middle one, where the epipolar lines of the other two cross
// (fig. 3 of the paper).
#pragma once

#include "geometry/camera.h"
#include "geometry/measurement.h"
#include "geometry/pose.h"

namespace edgeslam {

// Deviation, whitened by the middle measurement, of the middle view's pixel from where the other two views' epipolar
// lines cross in it. Where they cross at less than 2 degrees, the larger of the (Mahalanobis) distances to each line is
// taken instead; a view without a baseline to the middle one predicts its own bearing. Infinite where the lines cross
// behind the camera. Poses are camera to world. `middle` is the measurement in the middle view; the other two pixels
// are taken as exact, so for an edge point, whose place along the edge is not known, they err by as much as they slid.
double threeViewError(const Camera& camera, const Pose& world_T_first, const Pose& world_T_middle,
                      const Pose& world_T_last, const Eigen::Vector2d& first_pixel, const Measurement& middle,
                      const Eigen::Vector2d& last_pixel);

}  // namespace edgeslam
