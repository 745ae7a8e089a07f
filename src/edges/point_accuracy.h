// How exactly a point on an edge is measured: across the edge, along it, and whether it is known in both directions
// (design, section 5: what a measurement is).
#pragma once

#include <opencv2/core/mat.hpp>

#include "edges/structure_tensor.h"
#include "geometry/camera_mask.h"

namespace edgeslam {

struct PointAccuracyOptions {
  int tensor_window = 15;      // side of the structure tensor's window [px]
  double corner_ratio = 0.15;  // corner-like: l2 > corner_ratio * l1 ...
  double corner_strength = 6;  // ... and l2 > corner_strength [grey^2/px^2]
  double noise = 4;            // of the structure tensor, usually [grey^2/px^2]
  double sigma_edge = 0.3;     // across an edge [px]
  double sigma_corner = 0.17;  // of a corner-like point, across its stronger direction [px]
  // false: a point counts as if it were known along its edge as well as across; to measure the gain
  bool weigh_edges = true;
};

// Of the points of one image.
struct PointAccuracy {
  PointAccuracyOptions options;
  double excess_noise = 0;  // what the image has more than the usual noise [grey^2/px^2]
  double noise_factor = 1;  // how many times as far as presumed measurements err (tracking/measured_noise.h)
};

// Of the points of `grey` (CV_8U), whose noise is measured where `mask` does not hide it.
PointAccuracy accuracyIn(const cv::Mat& grey, const PointAccuracyOptions& options, const CameraMask* mask = nullptr);

// Standard deviation of a measurement across its edge, or of a corner-like point across its stronger direction [px].
double sigmaAcross(bool corner, const PointAccuracy& accuracy);

// Whether a point with these eigenvalues of its structure tensor is known in every direction.
bool isCornerLike(const Eigenvalues& values, const PointAccuracy& accuracy);

// What of the smaller eigenvalue is not noise, at least 1e-6: it holds a point along its edge [grey^2/px^2].
float informativeL2(float l2, const PointAccuracy& accuracy);

}  // namespace edgeslam
