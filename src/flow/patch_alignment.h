// Inverse-compositional alignment of a small patch with gain and bias (Lucas and Kanade 1981; Baker and Matthews 2004),
// damped towards a predicted position: the Levenberg term is negligible where the patch has texture and holds a point
// of a straight edge in place along the edge, where the image says nothing (design, section 5: flow).
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/mat.hpp>

namespace edgeslam {

constexpr int largest_patch_side = 15;

// The patch to be found, with what the inverse-compositional steps need of it.
struct PatchTemplate {
  using Samples = Eigen::Matrix<float, Eigen::Dynamic, 1, 0, largest_patch_side * largest_patch_side, 1>;
  int side = 0;        // [px], odd
  Samples grey;        // less their mean
  Samples gradient_x;  // of the patch, [grey/px], less their mean
  Samples gradient_y;
  Eigen::Matrix3f normal_matrix;  // of (x, y, gain); the bias is taken out by the means
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

}  // namespace edgeslam
