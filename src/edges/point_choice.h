// Choice of the points to track: spread over a grid and along chains; corner-like points first, then edges of every
// direction (design, section 5). A point's measurement accuracy follows from its structure tensor.
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "edges/edge_detection.h"
#include "edges/point_candidates.h"
#include "edges/point_spacing.h"
#include "edges/structure_tensor.h"

namespace edgeslam {

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

// Candidates of one kind in one cell of the grid: a heap in `ranked`, the best on top.
struct RankedCandidates {
  int begin = 0;
  int end = 0;
};

struct RankedCandidate {
  float strength;
  int candidate;
};

struct ChoiceCell {
  RankedCandidates corners;
  std::array<RankedCandidates, 4> edges;  // by direction
  std::array<int, 4> taken_of_direction{};
  int taken = 0;
};

// The best candidate of a cell, which it offers for the next round.
struct CellOffer {
  int cell;
  int candidate;
  float strength;
};

// Memory of choosePoints, to be used for one image after the other; about 10 bytes a pixel.
struct PointChoiceWorkspace {
  PointSpacing spacing;
  std::vector<PointCandidate> candidates;
  std::vector<ChoiceCell> cells;
  std::vector<RankedCandidate> ranked;  // a corner-like one is there twice
  std::vector<CellOffer> offers;
};

// Fills `chosen` with at most spread.count - occupied.size() new points, none nearer than `spread.spacing` to an
// occupied pixel or to each other. Allocates only where `workspace` and `chosen` were not used with these options for
// an image of this size, or `edges` has more than mostEdgePoints.
void choosePoints(const cv::Mat& grey, const EdgeMap& edges, const std::vector<Eigen::Vector2f>& occupied,
                  const PointSpread& spread, const PointAccuracy& accuracy, PointChoiceWorkspace& workspace,
                  std::vector<ChosenPoint>& chosen);

// The same in memory of its own.
std::vector<ChosenPoint> choosePoints(const cv::Mat& grey, const EdgeMap& edges,
                                      const std::vector<Eigen::Vector2f>& occupied, const PointSpread& spread,
                                      const PointAccuracy& accuracy);

// In memory of its own, for an image that has the usual noise.
std::vector<ChosenPoint> choosePoints(const cv::Mat& grey, const EdgeMap& edges,
                                      const std::vector<Eigen::Vector2f>& occupied, const PointChoiceOptions& options);

}  // namespace edgeslam
