// Choice of the points to track: spread over a grid and along chains; corner-like points first, then edges of every
// direction (design, section 5). A point's measurement accuracy follows from its structure tensor.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "edges/edge_detection.h"
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
  double noise = 4;            // of the structure tensor [grey^2/px^2]
  double sigma_edge = 0.3;     // across an edge [px]
  double sigma_corner = 0.17;  // of a corner-like point, across its stronger direction [px]
  double border = 12;          // points keep this distance from the image's border [px]
  bool weigh_edges =
      true;  // false: a point counts as if it were known along its edge as well as across; to measure the gain
};

struct ChosenPoint {
  Eigen::Vector2f pixel;  // sub-pixel [px]
  // Unit, from dark to bright: of a corner-like point the stronger direction of its structure tensor, of the others the
  // mean normal of the edge around it.
  Eigen::Vector2f normal;
  StructureTensor tensor;
  bool corner = false;
  int chain = -1;           // of the edge point it was made from
  float sigma_normal = 0;   // [px]
  float sigma_tangent = 0;  // [px]
};

// At most options.count - occupied.size() new points, none nearer than `spacing` to an occupied pixel or to each other.
std::vector<ChosenPoint> choosePoints(const cv::Mat& grey, const EdgeMap& edges,
                                      const std::vector<Eigen::Vector2f>& occupied, const PointChoiceOptions& options);

}  // namespace edgeslam
