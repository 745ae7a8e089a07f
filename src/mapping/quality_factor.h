// P15, the quality factor of an initial structure (section 3.3 of the paper): small straight pieces of edges must keep
// their neighbourhood and order from 2D to 3D; and where edges meet in the image they must meet in space.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace edgeslam {

// A reconstructed point of the first view.
struct QualityPoint {
  Eigen::Vector2d pixel;     // [px]
  Eigen::Vector2d normal;    // unit, across the edge
  Eigen::Vector3d bearing;   // unit
  double inverse_depth = 0;  // along the bearing; not positive: no depth
  double inverse_depth_sigma = 0;
  int chain = -1;
  int order = 0;  // along the chain
};

struct QualityOptions {
  // Farthest neighbours: in the image [px], and as the camera sees them. In a small image pixels lie far apart.
  double neighbour_px = 24;
  double neighbour_deg = 3.3;
  double straight_px = 1.0;            // a piece is straight where its middle lies so near to its chord [px]
  double same_depth_ratio = 0.12;      // neighbours' inverse depths agree within this share ...
  double straight_depth_ratio = 0.04;  // ... and a straight piece's middle lies on its chord within this one
};

struct QualityFactor {
  int pieces = 0;  // small straight pieces of edges, and neighbouring points of different edges
  int kept = 0;    // of these, the ones whose neighbourhood and order hold in 3D
  double share() const { return pieces > 0 ? static_cast<double>(kept) / pieces : 0.0; }
};

QualityFactor qualityFactor(std::vector<QualityPoint> points, const QualityOptions& options);

}  // namespace edgeslam
