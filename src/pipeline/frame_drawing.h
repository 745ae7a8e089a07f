// A frame with its edges and tracks drawn, for people: what was seen, what was followed, and what of it is mapped.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "edges/edge_detection.h"

namespace edgeslam {

struct DrawnTrack {
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();           // in this frame [px]
  Eigen::Vector2f keyframe_pixel = Eigen::Vector2f::Zero();  // of the same point in the last keyframe [px]
  Eigen::Vector2f normal = Eigen::Vector2f::UnitX();         // unit, across the edge, in this frame
  bool mapped = false;                                       // has a depth
  bool corner = false;                                       // known in both directions
};

// CV_8UC3 (BGR), the size of `grey` (CV_8U). Edges are faint, a colour a chain; tracks are dots, green where mapped,
// yellow where not yet, squares where corner-like, with a short tick across the edge otherwise; a thin line leads to
// each track from its place in the last keyframe. The caption stands in the lower left corner. Tracks that are not
// finite are left out. An empty `grey` gives an empty image.
cv::Mat drawFrame(const cv::Mat& grey, const EdgeMap& edges, const std::vector<DrawnTrack>& tracks,
                  const std::string& caption);

}  // namespace edgeslam
