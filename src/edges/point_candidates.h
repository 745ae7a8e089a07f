// The edge points among which those to track are chosen, each with what the choice goes by.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "edges/edge_detection.h"
#include "edges/point_accuracy.h"
#include "edges/point_spacing.h"
#include "edges/structure_tensor.h"

namespace edgeslam {

// How points are spread over an image.
struct PointSpread {
  int count = 550;            // points at most
  double spacing = 6;         // least distance between two points [px]
  int cell = 40;              // grid cell [px]
  double corner_share = 0.5;  // most of `count` that corner-like points may take first
  double border = 12;         // points keep this distance from the image's border [px]
};

struct PointChoiceOptions : PointSpread {
  PointAccuracyOptions accuracy;
};

// Along a chain every second edge point is a candidate: tensors change little in between.
constexpr size_t candidate_step = 2;

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

// Adds to `candidates` the points of `edges` that lie within the border of `grey` and are free.
void findPointCandidates(const cv::Mat& grey, const EdgeMap& edges, const PointSpacing& spacing,
                         const PointSpread& spread, const PointAccuracy& accuracy,
                         std::vector<PointCandidate>& candidates);

}  // namespace edgeslam
