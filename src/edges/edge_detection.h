// P1, P2: edges as zero crossings of a difference of Gaussians, one pixel wide, with their sub-pixel position across
// the edge and the normal from the grey values' gradient; joined into chains along the edge (P3).
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "edges/edge_pixels.h"
#include "geometry/camera_mask.h"
#include "image/difference_of_gaussians.h"

namespace edgeslam {

struct EdgePoint {
  Eigen::Vector2f pixel;   // sub-pixel [px]
  Eigen::Vector2f normal;  // unit, from dark to bright
  float gradient = 0;      // of the grey values across the edge [grey/px]
  int chain = -1;          // number of the chain
  int previous = -1;       // neighbours along the chain: index into EdgeMap::points, -1 at an end
  int next = -1;
};

// Ordered by chain, and along each chain with the brighter side on the left as seen on the screen. A closed chain's
// last point leads on to its first.
struct EdgeMap {
  std::vector<EdgePoint> points;
  int chain_count = 0;
  cv::Mat index;  // CV_32S, size of the image: index of the point in that pixel, or -1
};

// Memory of detectEdges, to be used for one image after the other; about 16 bytes a pixel.
struct EdgeWorkspace {
  DifferenceOfGaussians blurs;
  EdgePixels pixels;
  std::vector<int> ahead;  // of each pixel's best neighbours along the edge, as indices into pixels.points, or -1
  std::vector<int> behind;
};

// An empty map with memory for every edge that an image of this size may have, 12 bytes a pixel.
EdgeMap makeEdgeMap(const cv::Size& size);

// `grey` is CV_8U. An image without edges gives an empty map; of an image with more edge points than mostEdgePoints
// the lowest rows are left out. Where `mask` hides the image there are no edges. Allocates only where `workspace` was
// not used with these options for an image of this size, or `edges` has not the memory of makeEdgeMap.
void detectEdges(const cv::Mat& grey, const EdgeOptions& options, EdgeWorkspace& workspace, EdgeMap& edges,
                 const CameraMask* mask = nullptr);

// The edges of `grey` (CV_8U) in memory of their own.
EdgeMap detectEdges(const cv::Mat& grey, const EdgeOptions& options, const CameraMask* mask = nullptr);

// Index of the edge point nearest to `pixel` within `radius` [px] whose normal agrees (dot product at least
// `least_dot`; pass -1 to accept every direction), or -1.
int nearestEdgePoint(const EdgeMap& edges, const Eigen::Vector2f& pixel, const Eigen::Vector2f& normal, float radius,
                     float least_dot);

}  // namespace edgeslam
