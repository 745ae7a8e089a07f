// Inverse-compositional alignment of a small patch with gain and bias (Lucas and Kanade 1981; Baker and Matthews 2004),
// damped towards a predicted position: the Levenberg term is negligible where the patch has texture and holds a point
// of a straight edge in place along the edge, where the image says nothing (design, section 5: flow).
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "flow/patch_kernels.h"

namespace edgeslam {

// The patch to be found, with what the inverse-compositional steps need of it.
struct PatchTemplate {
  PatchSamples samples;
  // Means that were left in the samples by rounding, in their units.
  float grey_left = 0, x_left = 0, y_left = 0;
  Eigen::Matrix3f normal_matrix;  // of (x, y, gain) [grey, px]; the bias is taken out by the means
  Eigen::Matrix2f tensor;         // mean of g g^T [grey^2/px^2]
};

// Template from `image` (a pyramid level) around `pixel` [px of that level]. `warp` (2x2) takes offsets in the patch to
// offsets in `image`: identity for a patch seen from the same distance and angle. False where the patch leaves the
// readable part.
bool makeTemplate(const cv::Mat& image, const Eigen::Vector2f& pixel, const Eigen::Matrix2f& warp, int side,
                  PatchTemplate& patch);

struct AlignmentOptions {
  int iterations = 10;
  float damping = 3;          // Levenberg term towards the prediction [grey^2/px^2], per pixel of the patch
  float convergence = 0.02f;  // a shorter step ends the iteration [px]
};

struct AlignmentResult {
  bool inside = false;     // the patch stayed in the readable part of the image
  bool converged = false;  // the last step was short
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
  float correlation = 0;  // normalized cross-correlation at the last evaluated position
};

// Position in `image` that matches the patch best, from `start`, damped towards `prediction` [px of that level].
AlignmentResult alignPatch(const PatchTemplate& patch, const cv::Mat& image, const Eigen::Vector2f& start,
                           const Eigen::Vector2f& prediction, const AlignmentOptions& options);

// A window less the patch, each less its mean.
struct PatchDifference {
  float squares = 0;                                         // summed [grey^2]
  Eigen::Vector2f along_gradient = Eigen::Vector2f::Zero();  // times the patch's gradient, summed [grey^2/px]
};

// The difference of the window of `image` around `pixel`, which lies inside the image.
PatchDifference differenceAt(const PatchTemplate& patch, const cv::Mat& image, const Eigen::Vector2f& pixel);

// Normalized cross-correlation of the patch with `image` around `pixel`; -1 where it leaves the readable part.
float correlationAt(const PatchTemplate& patch, const cv::Mat& image, const Eigen::Vector2f& pixel);

}  // namespace edgeslam
