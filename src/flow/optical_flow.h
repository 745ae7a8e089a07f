// P5: sparse, iterative, pyramidal, window-based Lucas-Kanade flow, forward and backward.
#pragma once

#include "flow/patch_alignment.h"
#include "image/pyramid.h"

namespace edgeslam {

struct FlowOptions {
  int window = 15;                 // side of the patch [px]
  int levels = 4;                  // pyramid levels
  int finest_level = 0;            // the last of them: what is blurred shows nothing finer
  int iterations = 10;             // most steps a level
  double damping = 3;              // Levenberg term towards the prediction [grey^2/px^2]
  double forward_backward = 1.0;   // largest error of going there and back, across the edge [px of the finest level]
  double least_correlation = 0.7;  // normalized cross-correlation of the patch there
  double edge_distance = 1.5;      // a point farther from every edge of its direction is dropped [px]
  double redundancy = 1.5;         // of two points nearer to each other the younger is dropped [px]
};

struct FlowMatch {
  bool found = false;
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
  Eigen::Matrix2f tensor = Eigen::Matrix2f::Zero();  // structure tensor of the patch where it was taken [grey^2/px^2]
  float correlation = 0;
};

// Follows the patch around `pixel` in `from` into `to`, from the coarsest level down to the finest, starting at
// `prediction`. Pixels are of level 0, the tensor of the finest level.
FlowMatch followPoint(const ImagePyramid& from, const ImagePyramid& to, const Eigen::Vector2f& pixel,
                      const Eigen::Vector2f& prediction, const FlowOptions& options);

// There and back: error of the backward flow at the start, `across` the edge (unit normal) [px of level 0]; large where
// it failed.
float backwardError(const ImagePyramid& from, const ImagePyramid& to, const Eigen::Vector2f& from_pixel,
                    const Eigen::Vector2f& to_pixel, const Eigen::Vector2f& across, const FlowOptions& options);

}  // namespace edgeslam
