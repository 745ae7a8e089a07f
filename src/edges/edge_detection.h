// P1, P2: edges as zero crossings of a difference of Gaussians, one pixel wide, with their sub-pixel position across
// the edge and the normal from the grey values' gradient; joined into chains along the edge (P3).
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace edgeslam {

struct EdgeOptions {
  double sigma = 1.78;              // of the narrower Gaussian [px]
  double sigma_ratio = 1.26;        // wider over narrower
  int plane_fit_radius = 2;         // an edge is told by a plane fitted to (2 r + 1)^2 pixels of the DoG [px]
  double sign_balance = 0.4;        // most |positive - negative| / all of the DoG's signs in that window
  double gradient_threshold = 1.5;  // least grey-value gradient across the edge [grey/px]
  int shortest_chain = 6;           // shorter chains are no edges [points]
};

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

// `grey` is CV_8U. An image without edges gives an empty map.
EdgeMap detectEdges(const cv::Mat& grey, const EdgeOptions& options);

// Index of the edge point nearest to `pixel` within `radius` [px] whose normal agrees (dot product at least
// `least_dot`; pass -1 to accept every direction), or -1.
int nearestEdgePoint(const EdgeMap& edges, const Eigen::Vector2f& pixel, const Eigen::Vector2f& normal, float radius,
                     float least_dot);

}  // namespace edgeslam
