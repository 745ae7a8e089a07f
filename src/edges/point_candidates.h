// The edge points among which those to track are chosen, each with what the choice goes by.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "edges/edge_detection.h"
#include "edges/point_spacing.h"
#include "edges/structure_tensor.h"

namespace edgeslam {

struct PointChoiceOptions {
  int count = 550;             // points tracked at once
  double spacing = 6;          // least distance between two points [px]
  int cell = 40;               // grid cell [px]
  double corner_share = 0.5;   // most of `count` that corner-like points may take first
  int tensor_window = 15;      // side of the structure tensor's window [px]
  double corner_ratio = 0.15;  // corner-like: l2 > corner_ratio * l1 ...
  double corner_strength = 6;  // ... and l2 > corner_strength [grey^2/px^2]
  double noise = 4;            // of the structure tensor, usually [grey^2/px^2]
  double excess_noise = 0;     // what the image at hand has more than that (image_noise.h) [grey^2/px^2]
  double sigma_edge = 0.3;     // across an edge [px]
  double sigma_corner = 0.17;  // of a corner-like point, across its stronger direction [px]
  double border = 12;          // points keep this distance from the image's border [px]
  bool weigh_edges =
      true;  // false: a point counts as if it were known along its edge as well as across; to measure the gain
};

// Along a chain every second edge point is a candidate: tensors change little in between.
constexpr size_t kCandidateStep = 2;

struct PointCandidate {
  Eigen::Vector2f pixel;  // sub-pixel [px]
  // Unit, from dark to bright: of a corner-like point the stronger direction of its structure tensor, of the others the
  // mean normal of the edge around it.
  Eigen::Vector2f normal;
  GradientProducts products;  // over its structure tensor's window
  float l2 = 0;               // of the structure tensor [grey^2/px^2]
  float gradient = 0;         // of the edge point [grey/px]
  int chain = -1;             // of the edge point
  bool corner = false;
};

// Whether a point with these eigenvalues of its structure tensor is known in every direction.
bool isCornerLike(const Eigenvalues& values, const PointChoiceOptions& options);

// What of the smaller eigenvalue is not noise, at least 1e-6: it holds a point along its edge [grey^2/px^2].
float informativeL2(float l2, const PointChoiceOptions& options);

// Adds to `candidates` the points of `edges` that lie within the border of `grey` and are free.
void findPointCandidates(const cv::Mat& grey, const EdgeMap& edges, const PointSpacing& spacing,
                         const PointChoiceOptions& options, std::vector<PointCandidate>& candidates);

}  // namespace edgeslam
