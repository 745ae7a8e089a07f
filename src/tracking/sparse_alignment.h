// Motion between two frames from small patches around all tracks at once, coarse to fine (Forster et al. 2014, sparse
// model-based image alignment): a single edge can be taken for its neighbour, all of them together hardly. It starts
// the flow.
#pragma once

#include <memory_resource>
#include <vector>

#include "geometry/camera.h"
#include "geometry/pose.h"
#include "image/hidden_levels.h"
#include "image/pyramid.h"

namespace edgeslam {

struct AlignmentPoint {
  Eigen::Vector2f pixel;     // in the first frame [px]
  Eigen::Vector3d position;  // in the first camera's frame, map units
};

using AlignmentPoints = std::pmr::vector<AlignmentPoint>;

struct SparseAlignmentOptions {
  int coarsest_level = 4;
  int finest_level = 1;
  int iterations = 10;    // most steps a level
  int most_points = 300;  // more are thinned out evenly
  double huber = 12;      // of the grey difference, from where on it counts linearly [grey]
};

// A patch with its gradients reaches so far around its middle [px of the level].
constexpr int alignment_reach = 3;

// to_T_from, from the better of the two starts. Returns `first_start` where too few patches can be compared. `hidden`:
// where patches of that reach see what is masked; they do not count.
Pose alignSparsely(const Camera& camera, const ImagePyramid& from, const ImagePyramid& to,
                   const AlignmentPoints& points, const Pose& first_start, const Pose& second_start,
                   const SparseAlignmentOptions& options,
                   std::pmr::memory_resource* memory = std::pmr::get_default_resource(),
                   const HiddenLevels& hidden = {});

}  // namespace edgeslam
