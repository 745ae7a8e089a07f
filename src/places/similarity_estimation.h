// P26: the similarity between two sides of a loop, by Horn's method in RANSAC and by its refinement on whitened
// reprojection errors.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/camera.h"
#include "geometry/measurement.h"
#include "geometry/similarity.h"

namespace edgeslam {

// A point of the candidate's side, seen in the current image, and, where it is mapped there too, its counterpart.
struct PlaceCorrespondence {
  Eigen::Vector3d candidate_point;  // candidate's camera frame
  Measurement in_current;           // of the candidate's point, or of its counterpart
  bool paired = false;              // what follows holds
  Eigen::Vector3d current_point;    // current camera frame
  Measurement in_candidate;
  double depth_deviation = 0.1;  // of the ratio of the two distances
};

// Largest whitened error of a correspondence: in the current image; for a pair also in the candidate's image and in
// distance. Infinite behind a camera.
double correspondenceError(const Camera& camera, const PlaceCorrespondence& correspondence,
                           const Similarity& current_S_candidate);

struct SimilarityEstimate {
  bool found = false;
  Similarity current_S_candidate;
  std::vector<char> inliers;
  int inlier_count = 0;
};

// Horn's method on samples of three pairs, in RANSAC, then refined on all inliers. Not found: fewer than
// `fewest_inliers`. All correspondences must be paired.
SimilarityEstimate estimateSimilarity(const Camera& camera, const std::vector<PlaceCorrespondence>& pairs,
                                      double outlier, int fewest_inliers, int iterations, std::uint64_t seed);

// Gauss-Newton on the whitened errors of both images and of the distances, robust. Returns the refined similarity, or
// the one given where that fails.
Similarity refineSimilarity(const Camera& camera, const std::vector<PlaceCorrespondence>& correspondences,
                            const Similarity& start, double huber, int iterations);

}  // namespace edgeslam
